// The inner wall of the chest as a surface r(angle, height) about a line through the chest.
#pragma once

#include "plugins/segmenter/thorax/ribs.h"
#include "plugins/segmenter/thorax/skin.h"
#include "plugins/segmenter/thorax/sternum.h"

namespace pectora::thorax {

/// The polar grid: angle 0 points to the front, positive to the patient's left. The pole of a slice lies in the coronal
/// plane, before the spine's middle, so that -90 and 90 degrees lie in the coronal plane.
struct PolarGrid {
  static constexpr int kAngles = 161;
  static constexpr double kStepDeg = 1.5;
  std::vector<double> poleX;    ///< local mm, one a slice
  double poleY = 0;
  static double degrees(int n) { return (n - kAngles / 2) * kStepDeg; }
  Point2 at(int slice, double degrees, double radius) const;
};

/// Something that is known of the wall: its radius at an angle and height, with a weight.
struct WallSample {
  double angleIndex = 0;   ///< may lie between grid angles
  double slice = 0;
  double radius = 0;       ///< mm
  double weight = 1;
};

/// Outermost change from wall to lung along every ray of a slice, at `levelHu`, seen from outside; negative where there
/// is no lung. `skinRadius[n]` is where to start.
std::vector<double> lungRadii(const Field& field, const Body& body, const PolarGrid& grid, int slice,
                              const std::vector<double>& skinRadius, double levelHu);

/// Radius at which each ray first meets a closed outline from within; -1 if it does not.
std::vector<double> outlineRadii(const Loop& outline, const PolarGrid& grid, int slice);

/// Samples of the bony wall: `offsetMm` inside the ribs' inner surfaces (first fall below boneHu on the way to the pole
/// from the centreline), without the rib's last 45 mm before the spine, which are behind the wall; and inside the sternum's back.
std::vector<WallSample> ribWall(const std::vector<FoundRib>& ribs, const Field& field, const PolarGrid& grid, double boneHu, double offsetMm);
std::vector<WallSample> sternumWall(const std::vector<SternumSlice>& sternum, const PolarGrid& grid, double offsetMm);

/// Where the wall is to be expected when nothing shows it, for every slice and angle ((slice - firstSlice) * kAngles + n).
struct UsualWall {
  std::vector<double> radius;   ///< mm
  std::vector<double> weight;   ///< of a sample there
};
/// As far below the skin as nine tenths of the samples within 6 degrees at least are (on the side of the body where that is
/// less), but not beyond the radius that 97 % of them and of the lung's keep within; at the sides (more than 60 degrees from
/// the front) not beyond their median. The weight is faint (1e-5) within 40 mm of a sample at that angle and 1e-3 beyond.
/// `skinRadius[s][n]`, negative where unknown.
UsualWall usualWall(const std::vector<WallSample>& samples, const std::vector<WallSample>& lung,
                    const std::vector<std::vector<double>>& skinRadius, int firstSlice, double sliceSpacing);

/// The smooth surface through samples: least squares of the samples' misfit plus `stiffness` times the squared second
/// differences (thin plate), with a pull to the usual wall so that it stays put where nothing is known. Returns
/// radius[(slice - firstSlice) * kAngles + n]. Rows of the system are about 2.5 mm of slices; between them it is linear.
std::vector<double> fitWall(const std::vector<WallSample>& samples, const UsualWall& usual, int firstSlice,
                            int lastSlice, double sliceSpacing, double stiffness);

/// How far the lung stays behind the ribs (mm, positive: further in) around every place of the grid, from the rays on which both
/// are known: the mean with Gaussian weights of 20 mm around the chest and along it, further away of 60 mm; 0 where nothing is
/// known. Indices as in findPleura; `lung[s][n]` is negative where there is no lung.
std::vector<double> lungBehindRibs(const std::vector<WallSample>& ribs, const std::vector<std::vector<double>>& lung, int firstSlice,
                                   double sliceSpacing);

struct PleuraSettings {
  double lungLevelHu = -430;      ///< half-way between lung and wall
  double offsetMm = 1.5;          ///< pleura inside of bone
  double deepestMm = 6;           ///< lung farther than this inside the bony wall is not the wall (mediastinum, heart, liver)
  double effusionMm = 2;          ///< where the lung stays further behind the ribs than this, something lies between it and the wall
  double leastThicknessMm = 4;    ///< between skin and pleura
};

/// The inner wall in slices firstSlice to lastSlice: radius[(slice - firstSlice) * kAngles + n]. A first surface goes through the bony
/// wall (or, if there is none, through all lung) and, in three rounds, the backs of the cartilages that are seen near it. Lung within
/// `deepestMm` of it, or outside it, then joins it with a greater weight, and so four times more from the new surface, but never further
/// inside the first one than twice that, and nowhere that the lung stays behind the ribs (effusion, fat): there the bony wall stands. Where
/// no bone or cartilage is within 25 mm, nothing but lung shows the wall: it may lie four times as deep, and behind the ribs. The last
/// surface is cut back to `leastThicknessMm` inside the skin.
std::vector<double> findPleura(const Field& field, const Body& body, const PolarGrid& grid,
                               const std::vector<FoundRib>& ribs, const std::vector<SternumSlice>& sternum,
                               const std::vector<SkinSlice>& skin, int firstSlice, double boneHu,
                               const PleuraSettings& settings, const std::function<void(double)>& step = {});

}  // namespace pectora::thorax
