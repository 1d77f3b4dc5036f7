#include "plugins/loader/dicom/worker/data_set.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace pectora::dicom {

std::string textOf(const gdcm::DataSet& set, gdcm::Tag tag) {
  if (!set.FindDataElement(tag)) return "";
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (!value || value->GetLength() == 0) return "";
  std::string text(value->GetPointer(), value->GetLength());
  const std::size_t end = text.find('\0');
  if (end != std::string::npos) text.resize(end);
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<double> numbersOf(const gdcm::DataSet& set, gdcm::Tag tag) {
  const std::string text = textOf(set, tag);
  std::vector<double> numbers;
  const char* at = text.c_str();
  if (!*at) return {};
  while (true) {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at || !std::isfinite(number)) return {};
    numbers.push_back(number);
    while (*end == ' ') ++end;
    if (!*end) return numbers;
    if (*end != '\\') return {};
    at = end + 1;
  }
}

std::optional<int> shortOf(const gdcm::DataSet& set, gdcm::Tag tag, bool isSigned) {
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (!value || value->GetLength() < 2) return {};
  std::uint16_t word = 0;
  std::memcpy(&word, value->GetPointer(), 2);
  return isSigned ? int(std::int16_t(word)) : int(word);
}

gdcm::SmartPointer<gdcm::SequenceOfItems> sequenceOf(const gdcm::DataSet& set, gdcm::Tag tag) {
  if (!set.FindDataElement(tag)) return nullptr;
  return set.GetDataElement(tag).GetValueAsSQ();
}

const gdcm::DataSet* firstItem(const gdcm::DataSet& set, gdcm::Tag tag, gdcm::SmartPointer<gdcm::SequenceOfItems>& holder) {
  holder = sequenceOf(set, tag);
  if (!holder || holder->GetNumberOfItems() == 0) return nullptr;
  return &holder->GetItem(1).GetNestedDataSet();
}

}  // namespace pectora::dicom
