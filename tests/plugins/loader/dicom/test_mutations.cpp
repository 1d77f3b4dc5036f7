// Damage of every kind to one file of a small series. The process survives, and no damage goes unnoticed:
//
// - Damage outside of the value of PixelData: the volume is the original bit for bit with the original grid, or the series
//   is refused, or a warning tells that something is odd (a slope or intercept unlike the other slices', or a slice that
//   now belongs to another series).
// - Damage within PixelData has no checksum to show it. It may change the slice of that file, and nothing else.
#include "support.h"

#include <cerrno>
#include <cstdio>
#include <map>
#include <random>
#include <sys/wait.h>

namespace pectora::dicom {
namespace {

constexpr int kSlices = 6;

enum class Damage { truncation, headerBytes, anyBytes, field };

struct Mutator {
  std::mt19937 random;
  std::size_t below(std::size_t n) { return random() % n; }

  void flip(std::string& bytes, std::size_t from, std::size_t to) {
    for (std::size_t n = 1 + below(6); n > 0; --n) bytes[from + below(to - from)] = char(random());
  }
  // One element of the header gets another value, or goes.
  std::string changedField(const std::string& path) {
    PlainFile file(path);
    PlainFile::Element& e = file.elements[below(file.elements.size() - 1)];   // the last one is PixelData
    switch (below(4)) {
      case 0: file.remove(e.tag); break;
      case 1: e.value = std::string(e.value.size() + 2 * below(20), char('0' + below(10))); break;
      case 2: e.value.clear(); break;
      default:
        if (!e.value.empty()) flip(e.value, 0, e.value.size());
    }
    return file.bytes();
  }
};

// Where the value of PixelData begins: its tag is the last thing before it.
std::size_t pixelsAt(const std::string& bytes) {
  std::size_t at = bytes.find(std::string("\xe0\x7f\x10\x00", 4));
  if (at == std::string::npos) return bytes.size();
  const bool isExplicit = bytes[at + 4] == 'O';
  return at + (isExplicit ? 12 : 8);
}

TEST(Mutations, FiveHundredDamagedSeriesAreLoadedUnchangedOrRefused) {
  const Volume volume = patternVolume(64, 64, kSlices);
  const Storage kStorages[] = {Storage::explicitLittle, Storage::implicitLittle, Storage::explicitLittle, Storage::jpegLs,
                               Storage::rle, Storage::jpegLossless, Storage::jpeg2000, Storage::deflated};
  std::map<std::string, int> outcomes;
  TemporaryFolder folder;
  Mutator mutate{std::mt19937(20261123)};
  LoadOptions options = loadOptions();
  options.helpers.timeoutSeconds = 10;
  std::vector<std::string> names;
  for (int i = 0; i < 500; ++i) {
    const Storage storage = kStorages[std::size_t(i / 63) % std::size(kStorages)];
    if (i % 63 == 0) names = writeSeries(volume, folder.path, {.storage = storage});
    const std::size_t slice = mutate.below(kSlices);
    const std::string path = folder.path + "/" + names[slice];
    const std::string good = readBytes(path);
    // The pixels of deflated files lie anywhere: all of their damage counts as damage to pixels.
    const std::size_t pixels = storage == Storage::deflated ? 0 : pixelsAt(good);

    std::string bad = good;
    bool isInPixels = false;
    Damage damage = Damage(i % 4);
    if (damage == Damage::field && storage != Storage::explicitLittle) damage = Damage::headerBytes;
    switch (damage) {
      case Damage::truncation: bad.resize(mutate.below(good.size())); break;
      case Damage::headerBytes: mutate.flip(bad, 0, pixels > 0 ? pixels : good.size()); break;
      case Damage::anyBytes: mutate.flip(bad, 0, good.size()); break;
      case Damage::field: bad = mutate.changedField(path); break;
    }
    if (damage == Damage::anyBytes || pixels == 0) isInPixels = pixels < bad.size();
    writeBytes(path, bad);

    ListeningHost host;
    try {
      const Volume loaded = loadPath(folder.path, host, options);
      if (loaded.hu == volume.hu && loaded.grid.size == volume.grid.size) {
        ++outcomes["loaded as it was"];
        EXPECT_NEAR(distance(loaded.grid.origin, volume.grid.origin), 0, 1e-9) << i;
        EXPECT_NEAR(distance(loaded.grid.spacing, volume.grid.spacing), 0, 1e-9) << i;
      } else if (!host.warnings.empty()) {
        ++outcomes["loaded otherwise, with a warning"];
      } else {
        ++outcomes["loaded with other pixels in the damaged slice"];
        ASSERT_TRUE(isInPixels) << i << ": silently damaged";
        ASSERT_EQ(loaded.grid.size, volume.grid.size) << i;
        for (std::size_t v = 0; v < volume.hu.size(); ++v)
          if (v / volume.grid.sliceVoxels() != slice) {
            ASSERT_EQ(loaded.hu[v], volume.hu[v]) << i;
          }
      }
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find('.'), std::string::npos) << text;
      ++outcomes[text.find("broke the DICOM library") != std::string::npos ? "refused, and the helper died" : text.find("took more than") != std::string::npos ? "refused, and the helper hung" : "refused"];
    }
    writeBytes(path, good);
  }
  for (const auto& [outcome, count] : outcomes) std::printf("%4d %s\n", count, outcome.c_str());
  EXPECT_TRUE(waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD) << "no process is left";
}

}  // namespace
}  // namespace pectora::dicom
