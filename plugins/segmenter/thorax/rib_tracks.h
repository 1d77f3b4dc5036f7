// Rib sections joined from plane to plane into tracks.
#pragma once

#include "plugins/segmenter/thorax/rib_sections.h"

namespace pectora::thorax {

/// One body followed through the planes of a fan.
struct Track {
  struct Item {
    int plane = 0;        ///< degrees, see Fan
    Section section;
  };
  std::vector<Item> items;   ///< from the back (large plane numbers) to the front
  int backPlane() const { return items.front().plane; }
  int frontPlane() const { return items.back().plane; }
};

/// Gates of the tracking.
struct TrackingLimits {
  double gateMm = 6;         ///< largest RMS distance between a predicted contour and the one that continues it
  int patiencePlanes = 5;    ///< a track that was not seen in more planes than this has ended
  int longestGapPlanes = 30; ///< over which two tracks are joined, if they lie on one line
  double linkMm = 9;         ///< how far the one may pass the other's end when both are drawn on
  int leastPlanes = 8;       ///< a shorter track is dropped
};

/// Sweeps the planes from the back to the front: the contours of a plane are assigned (Hungarian method) to the tracks
/// whose last contour, moved on by the track's slope, has the least RMS distance; a contour that nothing claims begins
/// a track (birth), a track that finds nothing in some planes ends (death), and tracks that lie on one line are merged.
std::vector<Track> trackSections(const std::vector<std::vector<Section>>& sections, const TrackingLimits& limits);

}  // namespace pectora::thorax
