// Values of a GDCM data set as numbers and text.
#pragma once

#include <gdcmDataSet.h>
#include <gdcmSequenceOfItems.h>

#include <optional>
#include <string>
#include <vector>

namespace pectora::dicom {

/// An element's bytes without padding; "" if it is missing or empty.
std::string textOf(const gdcm::DataSet& set, gdcm::Tag tag);
/// Decimal strings, separated by "\". Empty if it is missing or any of them is not a finite number.
std::vector<double> numbersOf(const gdcm::DataSet& set, gdcm::Tag tag);
/// A 16-bit binary value (US or SS) in the byte order that GDCM read it into.
std::optional<int> shortOf(const gdcm::DataSet& set, gdcm::Tag tag, bool isSigned = false);
/// The items of a sequence; null if there is none.
gdcm::SmartPointer<gdcm::SequenceOfItems> sequenceOf(const gdcm::DataSet& set, gdcm::Tag tag);
/// The first item of a sequence; null if there is none. Valid as long as `holder` is.
const gdcm::DataSet* firstItem(const gdcm::DataSet& set, gdcm::Tag tag, gdcm::SmartPointer<gdcm::SequenceOfItems>& holder);

}  // namespace pectora::dicom
