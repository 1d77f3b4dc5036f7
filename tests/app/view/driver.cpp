// Under the address sanitizer the OpenGL driver stays mapped to the end: a leak can only be told by the name of who made it, and so be
// told from the driver's own (tests/sanitize.supp), while that is there.
#ifdef __SANITIZE_ADDRESS__
#include "app/view/app.h"

#include <gtest/gtest.h>

#include <dlfcn.h>

#include <fstream>

namespace {

class KeptDriver final : public testing::Environment {
  void SetUp() override {
    const pectora::view::ImGuiHolder imgui;
    const auto target = pectora::view::makeOffscreen(64, 64, 1);
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
      if (const auto at = line.find('/'); at != std::string::npos && (line.ends_with("_dri.so") || line.find("libgallium") != std::string::npos))
        dlopen(line.substr(at).c_str(), RTLD_NOW | RTLD_NODELETE);
  }
};

[[maybe_unused]] const auto* const kept = testing::AddGlobalTestEnvironment(new KeptDriver);

}  // namespace
#endif
