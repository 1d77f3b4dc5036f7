#include "plugins/loader/dicom/worker/decode.h"

#include "plugins/loader/dicom/hounsfield.h"
#include "plugins/loader/dicom/worker/mapped_file.h"

#include <gdcmImageReader.h>

namespace pectora::dicom {

std::string decodeFile(const char* path, const FileHeader& header, const std::vector<FrameHeader>& frames,
                       const std::vector<std::int16_t*>& targets) {
  const MappedFile file(path);
  if (!file.isOpen()) return "cannot be opened";
  MappedStream stream(file);
  gdcm::ImageReader reader;
  reader.SetStream(stream);
  if (!reader.Read()) return "has pixels that cannot be decoded";
  const gdcm::Image& image = reader.GetImage();
  const gdcm::PixelFormat format = image.GetPixelFormat();
  const unsigned* size = image.GetDimensions();
  const unsigned depth = image.GetNumberOfDimensions() > 2 ? size[2] : 1;
  if (int(size[0]) != header.columns || int(size[1]) != header.rows || int(depth) != header.frames)
    return "has pixels of another size than its header says";
  if (format.GetSamplesPerPixel() != 1) return "has coloured pixels";

  PixelCode code{.bitsAllocated = format.GetBitsAllocated(), .bitsStored = format.GetBitsStored(),
                 .highBit = format.GetHighBit(), .isSigned = format.GetPixelRepresentation() == 1};
  if (!isReadable(code)) return "has pixels of a size other than 8 or 16 bits";
  const std::size_t frameBytes = header.framePixels() * std::size_t(code.bitsAllocated / 8);
  std::vector<char> buffer(image.GetBufferLength());
  if (buffer.size() < frameBytes * frames.size()) return "has fewer pixels than its header says";
  if (!image.GetBuffer(buffer.data())) return "has pixels that cannot be decoded";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!targets[i]) continue;
    code.slope = frames[i].slope, code.intercept = frames[i].intercept;
    toHounsfield(code, buffer.data() + i * frameBytes, header.framePixels(), targets[i]);
  }
  return "";
}

}  // namespace pectora::dicom
