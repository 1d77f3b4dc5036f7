// A file's bytes, mapped, and a stream over them for GDCM.
#pragma once

#include <istream>
#include <streambuf>

namespace pectora::dicom {

/// Read-only mapping of a whole file.
class MappedFile {
 public:
  explicit MappedFile(const char* path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  bool isOpen() const { return isOpen_; }
  const unsigned char* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  const unsigned char* data_ = nullptr;
  std::size_t size_ = 0;
  bool isOpen_ = false;
};

/// A stream that reads a mapped file where it lies.
class MappedStream : private std::streambuf, public std::istream {
 public:
  explicit MappedStream(const MappedFile& file);

 private:
  std::streampos seekoff(std::streamoff offset, std::ios_base::seekdir from, std::ios_base::openmode) override;
  std::streampos seekpos(std::streampos position, std::ios_base::openmode mode) override;
};

}  // namespace pectora::dicom
