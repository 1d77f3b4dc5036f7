#include "plugins/loader/dicom/hounsfield.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace pectora::dicom {
namespace {

constexpr int kLow = -32768, kHigh = 32767;

// The stored bits of a word as a number.
template <class Word>
int storedValue(Word word, int shift, int unused, bool isSigned) {
  // The stored bits are moved to the top of the word, and back with or without their sign.
  const Word top = Word(word << unused);
  if (isSigned) return std::make_signed_t<Word>(top) >> (unused + shift);
  return top >> (unused + shift);
}

template <class Word>
void convert(const PixelCode& code, const unsigned char* from, std::size_t count, std::int16_t* to) {
  constexpr int kBits = 8 * sizeof(Word);
  const int unused = kBits - 1 - code.highBit, shift = code.highBit + 1 - code.bitsStored;
  const bool swap = code.isBigEndian && sizeof(Word) == 2;
  const auto word = [&](std::size_t i) {
    Word w;
    std::memcpy(&w, from + i * sizeof(Word), sizeof(Word));
    return swap ? Word(w << 8 | w >> 8) : w;
  };
  const bool isWhole = code.slope == 1 && code.intercept == std::floor(code.intercept) && std::abs(code.intercept) < 1e6;
  if (isWhole) {
    const int intercept = int(code.intercept);
    for (std::size_t i = 0; i < count; ++i)
      to[i] = std::int16_t(std::clamp(storedValue(word(i), shift, unused, code.isSigned) + intercept, kLow, kHigh));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double hu = code.slope * storedValue(word(i), shift, unused, code.isSigned) + code.intercept;
    to[i] = std::int16_t(std::clamp(std::round(hu), double(kLow), double(kHigh)));
  }
}

}  // namespace

bool isReadable(const PixelCode& code) {
  return (code.bitsAllocated == 8 || code.bitsAllocated == 16) && code.bitsStored >= 1 &&
         code.highBit < code.bitsAllocated && code.highBit + 1 >= code.bitsStored && std::isfinite(code.slope) &&
         std::isfinite(code.intercept);
}

void toHounsfield(const PixelCode& code, const void* from, std::size_t count, std::int16_t* to) {
  const auto* bytes = static_cast<const unsigned char*>(from);
  if (code.bitsAllocated == 8)
    convert<std::uint8_t>(code, bytes, count, to);
  else
    convert<std::uint16_t>(code, bytes, count, to);
}

}  // namespace pectora::dicom
