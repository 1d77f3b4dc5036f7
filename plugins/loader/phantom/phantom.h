// The virtual patient: from settings to CT, truth and post-operative scan.
#pragma once

#include "body.h"
#include "kernel/value/truth.h"
#include "kernel/value/volume.h"

#include <functional>
#include <string>

namespace pectora::phantom {

/// Everything that makes one patient. Lengths are mm of the patient unless said.
struct Settings {
  double haller = 4;             ///< Haller index, measured at the deepest level of the sternal body
  std::string type = "cup";      ///< cup, saucer, trench, asymmetric
  double eccentricity = 0;       ///< x of the deepest point; negative: patient's right
  double asymmetry = 0;          ///< -0.8 to 0.8; positive: the right half of the pit is wider
  double torsion = 0;            ///< degrees
  double flattening = 0.05;      ///< share of the chest's depth that is lost over its whole width
  double age = 16;               ///< years
  double bmi = 19.9;             ///< kg/m^2
  std::string coverage = "torso";  ///< torso, thorax
  int matrix = 512;
  double fov = 350;              ///< mm
  double sliceSpacing = 2.5;     ///< mm
  double turn = 0;               ///< degrees about z
  double shiftX = 0, shiftY = 0; ///< mm
  bool hasCouch = true, hasClothing = false;
  double noise = 18;             ///< SD, HU
  double texture = 1;            ///< factor on the tissues' own texture
  double calcification = 0;      ///< share of the cartilages that is calcified
  int seed = 1;
  double lift = 30;              ///< mm at the deepest point
  double scanSpacing = 2;        ///< mm
  double scanNoise = 0.6;        ///< mm along the normal
  double scanMisregistration = 0.5;  ///< mm between sweeps
  double landmarkNoise = 1;      ///< mm for each axis, scan landmarks only
};

/// A patient before and after the operation. Both share one undeformed torso.
struct Patient {
  Body before, after;
  double pitDepth = 0;   ///< displacement of the bone at the deepest point, mm
  Grid grid;             ///< of the CT
};

/// Chooses the pit's depth so that the Haller index is as asked (or, where the chest is rounder than that without a
/// pit, the chest's depth). Throws Error if no depth gives it.
Patient makePatient(const Settings& settings);

/// Called with a fraction from 0 to 1, from one thread at a time; it may throw to stop the work.
using Progress = std::function<void(double)>;

/// CT and labels of the patient before the operation.
struct Images {
  std::shared_ptr<const Volume> ct;
  std::shared_ptr<const Labels> labels;
};
Images rasterise(const Patient& patient, const Settings& settings, const Progress& progress);

/// The exact anatomy before the operation, on the CT's levels.
std::shared_ptr<const Truth> makeTruth(const Patient& patient, const Settings& settings,
                                       std::shared_ptr<const Labels> labels);

/// The four landmarks on the skin of `body`, in the CT frame: neck, navel, nipple_right, nipple_left.
Landmarks skinLandmarks(const Body& body);

/// A hand-held scan of the skin after the operation, in the scanner's own frame, with its landmarks.
struct Scan {
  std::shared_ptr<const Points> points;
  std::shared_ptr<const Landmarks> landmarks;
};
Scan scanSkin(const Patient& patient, const Settings& settings);

/// Level of the navel in the body frame.
double navelLevel(const SternumPlan& sternum);

}  // namespace pectora::phantom
