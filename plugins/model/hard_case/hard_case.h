// A scene that is hard to solve, and what must hold when a solver meets it.
#pragma once

#include "kernel/value/motion.h"
#include "kernel/value/plan.h"

namespace pectora {

/// What a solver must make of a case. Always: nothing but finite numbers, no energy that grows, no silence.
enum class Must {
  recover,   ///< converge at rest, to 1e-6 of the wall's extent
  settle,    ///< converge with no cell turned inside out
  tell,      ///< the same, or say what is wrong: a status with its message, or cells turned inside out
  flag,      ///< not pass as sound: a status with its message, cells turned inside out, or a refusal
  refuse,    ///< be refused before any work
};
const char* mustName(Must must);

struct HardCase : Value {
  static constexpr const char* kName = "HardCase";
  std::string name, next;      ///< its name, and that of the next in the table, empty after the last
  std::string text;            ///< what is hard about it, in one sentence
  Must must = Must::tell;
  bool isSpringsAlone = true;  ///< false: solvers for springs alone must refuse it
  bool isInTime = false;       ///< true: solvers that find the wall at rest alone must refuse it
  double timeStep = 0;         ///< s, which explicit solvers must refuse if it is above 0; 0: the solver's own
  double loadStep = 0;         ///< mm, for solvers that step along the movement; 0: the solver's own
  double extent = 0;           ///< greatest length of the wall, mm
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Plan> plan;
  std::shared_ptr<const Motion> start;   ///< null: at rest

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  /// `scene`, `plan` and `start`, which is nil where it is rest.
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
};

/// The names of all cases, in order.
std::vector<std::string> hardCaseNames();
/// A case of that list with about `size` points a side; `seed` is for those with chance in them. Throws std::out_of_range
/// for an unknown name.
std::shared_ptr<HardCase> makeHardCase(const std::string& name, int size, unsigned seed);
/// A scene drawn from a seed: geometry, stiffness contrast 1e-3 to 1e9, masses, lift to 80 mm; one in five has damaged input.
std::shared_ptr<HardCase> makeRandomCase(unsigned seed);

}  // namespace pectora
