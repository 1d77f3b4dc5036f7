#include "plugins/loader/dicom/worker/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pectora::dicom {

MappedFile::MappedFile(const char* path) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
    size_ = std::size_t(status.st_size);
    isOpen_ = true;
    if (size_ > 0) {
      void* memory = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
      isOpen_ = memory != MAP_FAILED;
      if (isOpen_) data_ = static_cast<const unsigned char*>(memory);
    }
  }
  close(descriptor);
}

MappedFile::~MappedFile() {
  if (data_) munmap(const_cast<unsigned char*>(data_), size_);
}

MappedStream::MappedStream(const MappedFile& file) : std::istream(static_cast<std::streambuf*>(this)) {
  // The get area is never written to.
  char* begin = reinterpret_cast<char*>(const_cast<unsigned char*>(file.data()));
  setg(begin, begin, begin + file.size());
}

std::streampos MappedStream::seekoff(std::streamoff offset, std::ios_base::seekdir from, std::ios_base::openmode) {
  const std::streamoff size = egptr() - eback();
  const std::streamoff base = from == std::ios_base::beg ? 0 : from == std::ios_base::cur ? gptr() - eback() : size;
  const std::streamoff target = base + offset;
  if (target < 0 || target > size) return std::streampos(std::streamoff(-1));
  setg(eback(), eback() + target, egptr());
  return std::streampos(target);
}

std::streampos MappedStream::seekpos(std::streampos position, std::ios_base::openmode mode) {
  return seekoff(std::streamoff(position), std::ios_base::beg, mode);
}

}  // namespace pectora::dicom
