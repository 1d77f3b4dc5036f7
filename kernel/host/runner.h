// Runs stages: checks settings and inputs, attaches provenance, answers from the cache.
#pragma once

#include "kernel/host/probe.h"
#include "kernel/host/registry.h"
#include "kernel/host/settings.h"
#include "kernel/stage/solver.h"

#include <atomic>
#include <list>

namespace pectora {

/// Where a run's messages go. Called from the thread that runs the stage, or its workers.
class Messages {
 public:
  virtual ~Messages() = default;
  virtual void progress(const std::string& /*stage*/, double /*fraction*/, const std::string& /*what*/) {}
  virtual void info(const std::string& /*stage*/, const std::string& /*message*/) {}
  virtual void warn(const std::string& /*stage*/, const std::string& /*message*/) {}
  /// A stage, solver or effect call is about to be run, its settings and inputs (by port) checked. May throw Cancelled.
  virtual void starting(const std::string& /*id*/, const Settings& /*settings*/, const std::vector<std::vector<Handle>>& /*inputs*/) {}
  /// A stage ended; `cached` says that the result came from the cache.
  virtual void finished(const Record& /*record*/, bool /*cached*/) {}
  /// What it returned, one handle an output.
  virtual void made(const std::vector<Handle>& /*outputs*/) {}
  /// Where a running solver's nodes are (Host::preview).
  virtual void preview(const NodeVectors& /*positions*/) {}
};

/// What `pectora explain` tells of one solve.
struct Explanation {
  std::string solver;
  std::size_t skinPoints = 0, freeNodes = 0, anchors = 0;
  std::vector<EffectUse> effects;
  double uncertainty = NAN;   ///< of what each changes, mm
  std::vector<std::pair<std::string, double>> termMilliseconds;   ///< one evaluation of each term, measured here
};
/// Thrown in place of solving when a runner only explains.
struct Explained : std::exception {
  const char* what() const noexcept override { return "explained"; }
};

/// Name of the setting that every solver has: pass on a result whose status is not "converged".
inline constexpr const char* kAcceptUnconverged = "accept_unconverged";

class Runner {
 public:
  Runner(Registry& registry, Messages& messages, std::atomic<bool>& cancel);

  /// Inputs by port, in the order of ports(id).
  using PortInputs = std::vector<std::vector<Handle>>;
  /// The input ports of any plugin. An effect has none; every solver has scene, plan and an optional start.
  const std::vector<Port>& ports(const std::string& id);
  /// Every parameter of a plugin with its default.
  std::vector<Parameter> parametersOf(const std::string& id);
  /// Runs a stage or solver, or makes an effect call. One handle an output. Throws Error, Cancelled or Explained.
  std::vector<Handle> run(const std::string& id, const Settings& settings, const PortInputs& inputs);

  /// If set, solvers are not run: their problem is explained, and Explained is thrown.
  std::vector<Explanation>* explanations = nullptr;
  /// Bytes of values that the cache may hold on to (least recently used goes first).
  std::size_t cacheBudget = std::size_t(2) << 30;

 private:
  struct CacheEntry {
    std::string key;
    std::vector<Handle> handles;
    std::size_t bytes;
  };
  void checkInputs(const Plugin& plugin, const PortInputs& inputs) const;
  std::vector<Handle> fromCache(const std::string& key);
  void keep(const std::string& key, const std::vector<Handle>& handles);
  std::shared_ptr<const Motion> solve(const Plugin& plugin, std::unique_ptr<Solver> solver, const PortInputs& inputs, bool accept, Host& host,
                                      Record& record);
  void explain(const Plugin& plugin, const Compiled& compiled, const Scene& scene, const Probe& probe);

  Registry& registry_;
  Messages& messages_;
  std::atomic<bool>& cancel_;
  std::list<CacheEntry> cache_;   // most recently used first
};

}  // namespace pectora
