#include "support.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace pectora::dicom {
namespace {

bool isLong(const std::string& vr) { return vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN"; }

std::string little(unsigned value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i) & 0xff);
  return text;
}

unsigned littleAt(const std::string& bytes, std::size_t at, int count) {
  unsigned value = 0;
  for (int i = 0; i < count; ++i) value |= unsigned(static_cast<unsigned char>(bytes.at(at + std::size_t(i)))) << (8 * i);
  return value;
}

std::string elementBytes(const PlainFile::Element& e) {
  std::string text = little(e.tag >> 16, 2) + little(e.tag & 0xffff, 2) + e.vr;
  text += isLong(e.vr) ? little(0, 2) + little(unsigned(e.value.size()), 4) : little(unsigned(e.value.size()), 2);
  return text + e.value;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "pectora-dicom-XXXXXX").string();
  if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
  path = pattern;
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

Volume patternVolume(int columns, int rows, int slices) {
  Volume volume;
  volume.grid.size = {columns, rows, slices};
  volume.grid.spacing = {0.75, 0.8, 2.5};
  volume.grid.origin = {-100.5, -80.25, -300};
  volume.hu.resize(volume.grid.voxels());
  for (int k = 0; k < slices; ++k)
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i)
        volume.hu[volume.grid.index(i, j, k)] = std::int16_t((i * 31 + j * 97 + k * 389 + i * j * 7) % 4096 - 1024);
  return volume;
}

LoadOptions loadOptions() {
  LoadOptions options;
  options.helpers.program = std::string(PECTORA_PLUGINS) + "/pectora-dicom";
  return options;
}

Volume loadPath(const std::string& path, Host& host, const LoadOptions& options) { return load(filesOf(path), options, host); }

std::string refusal(const std::string& path, const LoadOptions& options) {
  ListeningHost host;
  try {
    loadPath(path, host, options);
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << path << " was loaded";
  return "";
}

std::string readBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void writeBytes(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), std::streamsize(bytes.size()));
}

PlainFile::PlainFile(const std::string& path) {
  const std::string all = readBytes(path);
  for (std::size_t at = 132; at + 8 <= all.size();) {
    Element e;
    e.tag = littleAt(all, at, 2) << 16 | littleAt(all, at + 2, 2);
    e.vr = all.substr(at + 4, 2);
    const std::size_t length = isLong(e.vr) ? littleAt(all, at + 8, 4) : littleAt(all, at + 6, 2);
    at += isLong(e.vr) ? 12 : 8;
    e.value = all.substr(at, length);
    at += length;
    elements.push_back(e);
  }
}

void PlainFile::set(unsigned tag, const std::string& vr, std::string value) {
  if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
  remove(tag);
  elements.push_back({tag, vr, value});
}
void PlainFile::setShort(unsigned tag, int value) { set(tag, "US", little(unsigned(value), 2)); }
void PlainFile::remove(unsigned tag) {
  std::erase_if(elements, [&](const Element& e) { return e.tag == tag; });
}
std::string PlainFile::value(unsigned tag) const {
  for (const Element& e : elements)
    if (e.tag == tag) return e.value;
  return "";
}

std::string PlainFile::bytes() const {
  std::vector<Element> sorted = elements;
  std::sort(sorted.begin(), sorted.end(), [](const Element& a, const Element& b) { return a.tag < b.tag; });
  std::string meta, data;
  for (const Element& e : sorted)
    if (e.tag != 0x00020000) (e.tag >> 16 == 2 ? meta : data) += elementBytes(e);
  return std::string(128, '\0') + "DICM" + elementBytes({0x00020000, "UL", little(unsigned(meta.size()), 4)}) + meta + data;
}

std::string sequence(const std::vector<std::vector<PlainFile::Element>>& items) {
  std::string text;
  for (const auto& item : items) {
    std::string data;
    for (const PlainFile::Element& e : item) data += elementBytes({e.tag, e.vr, e.value.size() % 2 ? e.value + " " : e.value});
    text += little(0xfffe, 2) + little(0xe000, 2) + little(unsigned(data.size()), 4) + data;
  }
  return text;
}

}  // namespace pectora::dicom
