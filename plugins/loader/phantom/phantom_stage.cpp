// loader.phantom: a virtual patient whose exact anatomy is known, instead of a CT from disk.
#include "phantom.h"
#include "kernel/stage/plugin.h"

namespace pectora::phantom {
namespace {

class PhantomStage final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("haller", s_.haller, "", {1.8, 20}, {2, 8},
           "Haller index at the deepest level of the sternal body: inner width over sternum-to-vertebra distance. "
           "A normal chest has about 2.45; below that it is made rounder.");
    v.choice("type", s_.type, {"cup", "saucer", "trench", "asymmetric"},
             "Shape of the pit: narrow and round, wide and shallow-edged, long and oblique to the right, or a pit to "
             "the right with a turned sternum.");
    v.real("eccentricity", s_.eccentricity, "mm", {-40, 40}, {-25, 25},
           "How far the pit's middle lies to the patient's left (negative: right); adds to that of the type.");
    v.real("asymmetry", s_.asymmetry, "", {-0.45, 0.45}, {-0.4, 0.4},
           "Wider right (positive) or left half of the pit, as a share of its width; adds to that of the type.");
    v.real("torsion", s_.torsion, "deg", {-45, 45}, {-30, 30},
           "Rotation of the sternum about its axis, positive: left side deeper; adds to that of the type.");
    v.real("flattening", s_.flattening, "", {0, 0.2}, {0, 0.2},
           "Share of the chest's depth that is lost over its whole width, beside the pit. A mild index is "
           "reached with less of it and no pit.");
    v.real("age", s_.age, "years", {6, 60}, {10, 18}, "Size of the body, by the growth of the sternum up to 18 years.");
    v.real("bmi", s_.bmi, "kg/m^2", {13, 35}, {16, 26}, "Thickness of the fat, by the square of bmi / 20.");
    v.choice("coverage", s_.coverage, {"torso", "thorax"},
             "What the CT shows: from the neck to below the navel, or to below the costal arch (without the navel).");
    v.integer("matrix", s_.matrix, "pixels", {128, 1024}, {128, 512}, "Pixels along each side of a slice.");
    v.real("fov", s_.fov, "mm", {200, 600}, {300, 450}, "Side of a slice.");
    v.real("slice_spacing", s_.sliceSpacing, "mm", {0.5, 10}, {1, 5}, "Distance and thickness of the slices.");
    v.real("turn", s_.turn, "deg", {-20, 20}, {-10, 10}, "Rotation of the patient in the scanner about the z axis.");
    v.real("shift_x", s_.shiftX, "mm", {-100, 100}, {-30, 30}, "Shift of the patient in the scanner to his left.");
    v.real("shift_y", s_.shiftY, "mm", {-100, 100}, {-30, 30}, "Shift of the patient in the scanner to the back.");
    v.flag("couch", s_.hasCouch, "The scanner's couch below the patient.");
    v.flag("clothing", s_.hasClothing, "A thin shirt.");
    v.real("noise", s_.noise, "HU", {0, 200}, {0, 80}, "Standard deviation of the CT's noise.");
    v.real("texture", s_.texture, "", {0, 3}, {0, 2}, "Factor on the tissues' own unevenness.");
    v.real("calcification", s_.calcification, "", {0, 1}, {0, 0.5},
           "Share of the costal cartilages that is calcified.");
    v.integer("seed", s_.seed, "", {0, 2147483647}, {1, 100},
              "Chooses noise, texture, vessels and the scanner's errors.");
    v.real("lift", s_.lift, "mm", {0, 80}, {0, 60},
           "Elevation of the deepest bony point by the operation. The sternum turns about a pivot 160 mm cranial of "
           "it; more than the pit's depth gives an overcorrected chest.");
    v.real("scan_spacing", s_.scanSpacing, "mm", {0.3, 10}, {0.5, 3}, "Distance of the scan's points and lines.");
    v.real("scan_noise", s_.scanNoise, "mm", {0, 5}, {0, 2}, "Standard deviation of the scan along the normal.");
    v.real("scan_misregistration", s_.scanMisregistration, "mm", {0, 10}, {0, 1},
           "RMS shift between the scan's sweeps.");
    v.real("landmark_noise", s_.landmarkNoise, "mm", {0, 20}, {0, 5},
           "Standard deviation of the scan's landmarks along each axis. The CT's are exact.");
  }

  Outputs run(const Inputs&, Host& host) override {
    host.progress(0, "shaping the body");
    const Patient patient = makePatient(s_);
    host.checkCancel();
    const Images images = rasterise(patient, s_, [&](double done) {
      host.checkCancel();
      host.progress(0.05 + 0.85 * done, "drawing slices");
    });
    host.progress(0.9, "measuring the truth");
    auto truth = makeTruth(patient, images.labels);
    for (const LayerSlice& slice : truth->anatomy->skin)
      if (slice.clipped) {
        host.warn("the body is wider than the field of view: raise fov or lower bmi, turn or shift");
        break;
      }
    host.checkCancel();
    host.progress(0.95, "scanning the skin");
    const Scan scan = scanSkin(patient, s_);
    auto onSkin = std::make_shared<Landmarks>(skinLandmarks(patient.before));
    if (onSkin->find("navel")->position.z < patient.grid.origin.z) {
      std::erase_if(onSkin->points, [](const Landmark& l) { return l.name == "navel"; });
      host.warn("the CT ends above the navel: ct_landmarks has three points, use coverage = \"torso\" for all four");
    }
    return {images.ct, truth, scan.points, onSkin, scan.landmarks};
  }

 private:
  Settings s_;
};

}  // namespace
}  // namespace pectora::phantom

PECTORA_STAGE(pectora::phantom::PhantomStage, {
  .id = "loader.phantom", .version = "1.0",
  .summary = "A virtual patient with pectus excavatum: CT, exact anatomy, and a scan after the operation",
  .references = "Rib and sternum dimensions, deformity types and tissue figures: science notes, section 1 (Kelly 2013; "
                "MDCT sternum n = 200; Li, sternal length and age).",
  .inputs = {},
  .outputs = {{"ct", {"Volume"}}, {"truth", {"Truth"}}, {"scan", {"Points"}}, {"ct_landmarks", {"Landmarks"}},
              {"scan_landmarks", {"Landmarks"}}}})
