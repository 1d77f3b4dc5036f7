// Measures a chest level by level: inside from sternum, vertebra and inner wall, outside from the skin.
#pragma once

#include "kernel/value/anatomy.h"
#include "kernel/value/mesh.h"

#include <span>

namespace pectora {

/// The bony part of a level's lengths from the sternum's closed contour there (may be empty), the front of the vertebral body and
/// the inner wall from right to left (may be empty), for a patient who is turned about z by `turnDeg`. The rest stays 0.
LevelMetrics measureLevel(double z, std::span<const Vec3> sternum, Vec3 vertebralFront, std::span<const Vec3> innerWall, double turnDeg);

/// Angle of a contour's midline (midway between front and back in 24 columns over the middle 0.8 of its width) against x by
/// linear regression, degrees; positive: the left side lies deeper. Unlike the principal axis it also holds for a steep sternum,
/// which an axial slice cuts to nearly a square. 0 for a contour without width.
double sectionTorsion(std::span<const Vec3> contour);

/// Fills in the lengths of the skin, from its front at that level (from right to left, or in any order) and the depth of its most
/// posterior point, both in the patient's axes about `vertebralFront`. The two summits are the most anterior points right and left
/// of the vertebra; the pit is the most posterior point between them. Nothing is filled in from fewer than three points.
void measureSkin(LevelMetrics& level, std::span<const Vec3> front, Vec3 vertebralFront, double turnDeg, double width, double backDepth);

/// The front of a surface at height z: its crossings with that plane (points of a cloud within 2.5 mm of it, joined over bins of
/// 4 mm) in front of `vertebralFront` and less than `halfWidth` beside it, from right to left.
std::vector<Vec3> frontAt(const Mesh& mesh, double z, Vec3 vertebralFront, double halfWidth);
std::vector<Vec3> frontAt(const Points& points, double z, Vec3 vertebralFront, double halfWidth);

/// Between skin and convex hull over all levels, mL: the sum of their areas times their distance.
double concavityVolume(std::span<const LevelMetrics> levels);

/// The indices of one level beside Haller's and the correction index, as scripts and summaries show them; those whose lengths
/// are not known are not a number.
std::vector<Fact> levelFacts(const LevelMetrics& level);

}  // namespace pectora
