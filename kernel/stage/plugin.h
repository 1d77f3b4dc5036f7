// What a plugin's shared library exports.
//
// A stage plugin in one file:
//
//   class Invert final : public pectora::Stage { ... };
//   PECTORA_STAGE(Invert, {
//     .id = "segmenter.invert", .version = "1.0",
//     .summary = "One line that says what it does.",
//     .references = "Author, title, year.",
//     .inputs = {{"ct", {"Volume"}}}, .outputs = {{"anatomy", {"Anatomy"}}}})
#pragma once

#include "kernel/stage/stage.h"

#include <functional>

namespace pectora {

class Effect;
class Solver;

/// Everything that the host knows of a plugin before it makes one. Exactly one of the factories is set.
struct Descriptor {
  std::string id;                 ///< "stage.name", equal to the file's name without ".so"
  std::string version;
  std::string summary;            ///< one line
  std::string references = {};    ///< where the method comes from
  std::vector<Port> inputs = {};  ///< stages only
  std::vector<Port> outputs = {}; ///< stages only
  bool isCacheable = true;        ///< false for stages that write files
  std::function<std::unique_ptr<Stage>()> makeStage = {};
  std::function<std::unique_ptr<Effect>()> makeEffect = {};
  std::function<std::unique_ptr<Solver>()> makeSolver = {};
};

}  // namespace pectora

// Version of the interface between kernel and plugins: raise it when a type in kernel/value, kernel/physics or
// kernel/stage changes.
#define PECTORA_INTERFACE "9"

#define PECTORA_TEXT_(x) #x
#define PECTORA_TEXT(x) PECTORA_TEXT_(x)
#if defined(__SANITIZE_ADDRESS__)
#define PECTORA_SANITIZE "address"
#elif defined(__SANITIZE_THREAD__)
#define PECTORA_SANITIZE "thread"
#else
#define PECTORA_SANITIZE "none"
#endif
#if defined(_GLIBCXX_DEBUG)
#define PECTORA_CONTAINERS "debug"
#else
#define PECTORA_CONTAINERS "plain"
#endif

/// All that must be equal in kernel and plugin for their C++ types to have one layout.
#define PECTORA_BUILD_STAMP                                                                              \
  "interface " PECTORA_INTERFACE "; gcc-abi " PECTORA_TEXT(__GXX_ABI_VERSION) "; libstdc++ abi "         \
  PECTORA_TEXT(_GLIBCXX_USE_CXX11_ABI) "; containers " PECTORA_CONTAINERS "; sanitizer " PECTORA_SANITIZE \
  "; c++ " PECTORA_TEXT(__cplusplus)

#define PECTORA_PLUGIN_(Type, Base, factory, ...)                                                   \
  extern "C" __attribute__((visibility("default"))) const char* pectora_build_stamp() {             \
    return PECTORA_BUILD_STAMP;                                                                     \
  }                                                                                                 \
  extern "C" __attribute__((visibility("default"))) const pectora::Descriptor* pectora_plugin() {   \
    static const pectora::Descriptor descriptor = [] {                                              \
      pectora::Descriptor d __VA_ARGS__;                                                            \
      d.factory = []() -> std::unique_ptr<pectora::Base> { return std::make_unique<Type>(); };      \
      return d;                                                                                     \
    }();                                                                                            \
    return &descriptor;                                                                             \
  }
#define PECTORA_STAGE(Type, ...) PECTORA_PLUGIN_(Type, Stage, makeStage, __VA_ARGS__)
#define PECTORA_EFFECT(Type, ...) PECTORA_PLUGIN_(Type, Effect, makeEffect, __VA_ARGS__)
#define PECTORA_SOLVER(Type, ...) PECTORA_PLUGIN_(Type, Solver, makeSolver, __VA_ARGS__)
