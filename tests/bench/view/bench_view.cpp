// What a user of the window waits for: a picture of 200,000 lit triangles, drawn in software, and the new skin after the bar or a
// spring constant was moved. "points" are those of the skin; a wall's time is from the wish to the skin in the results, as the
// window takes it: plan, compiled scene, solve; of it "beside_solver_ms" are not the solver's. Walls are of springs alone, and with ribs in the pleura's way as the window begins.
#include "app/view/app.h"
#include "app/view/render/renderer.h"
#include "app/view/session/worker.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <thread>

namespace {
using namespace pectora;
using namespace pectora::view;

// A wavy sheet of rows x columns points before the camera.
Surface sheet(int rows, int columns) {
  Surface s;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double x = -200 + 400.0 * c / (columns - 1), z = -200 + 400.0 * r / (rows - 1);
      s.points.push_back({x, 20 * std::sin(0.05 * x) * std::cos(0.04 * z), z});
    }
  s.triangles = layerMesh(rows, columns, {}).triangles;
  s.computeNormals();
  return s;
}

void drawing(benchmark::State& state) {
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(1280, 800, 1);
  const Renderer renderer;
  const Surface surface = sheet(317, 317);   // 2 x 316 x 316 triangles
  GpuSurface gpu;
  gpu.upload(surface);
  Frame frame;
  frame.resize(720, 700, state.range(0) != 0);   // the scene's place in a window of 1280 x 800
  Camera camera;
  camera.aspect = 720.0 / 700;
  camera.frame({}, 220);
  for (auto _ : state) {
    camera.yaw += 0.01;
    renderer.draw(frame, camera, {{&gpu, {}}}, {}, 3.2f);
    benchmark::DoNotOptimize(readPixels(frame.framebuffer(), 1, 1));   // waits for the picture
  }
  state.counters["triangles"] = double(surface.triangles.size());
}

// From the points of a new skin to what the next picture is drawn from.
void updating(benchmark::State& state) {
  const ImGuiHolder imgui;
  const auto target = makeOffscreen(1280, 800, 1);
  Surface surface = sheet(224, 224);
  GpuSurface gpu;
  gpu.upload(surface);
  for (auto _ : state) {
    surface.computeNormals();
    gpu.uploadPoints(surface);
  }
  state.counters["points"] = double(surface.points.size());
}

// A phantom in the window's pipeline, solved; made once for each wall.
struct Desk {
  Registry registry{{PECTORA_PLUGINS}};
  Worker worker{registry, [] {}};
  Choices choices = initialChoices({"solver.newton"});
  double lift = 20, modulus = 20;
  bool isRising = true;

  Desk(double spacing, bool hasContact) {
    choices.source = Source::phantom;
    choices.loader = {"loader.phantom", {{"matrix", 256.0}}};
    assign(choices.model.settings, "spacing", spacing);
    assign(choices.planner.settings, "lift", lift);
    if (spacing < 6) choices.solver = {"solver.multigrid"};
    if (!hasContact) std::erase_if(choices.effects, [](const EffectChoice& effect) { return effect.plugin.id == "effect.rib_contact"; });
    after(false);
  }
  std::shared_ptr<const Results> after(bool isDragging) {
    const auto before = worker.results();
    worker.want(choices, isDragging);
    do std::this_thread::sleep_for(std::chrono::microseconds(200));
    while (worker.activity().isBusy || worker.results() == before);
    return worker.results();
  }
  static Desk& of(double spacing, bool hasContact) {
    static std::map<std::pair<double, bool>, std::unique_ptr<Desk>> all;
    auto& desk = all[{spacing, hasContact}];
    if (!desk) desk = std::make_unique<Desk>(spacing, hasContact);
    return *desk;
  }
};

void follow(benchmark::State& state, bool isBar, bool hasContact) {
  Desk& desk = Desk::of(double(state.range(0)) / 100, hasContact);
  double sum = 0, beside = 0;
  for (auto _ : state) {
    // Up and down between 16 and 28 mm by 2 mm, never twice to the same plan, which the runner would remember; or by 20 % of a stiffness.
    if (desk.lift <= 16 || desk.lift >= 28) desk.isRising = desk.lift <= 16;
    if (isBar) assign(desk.choices.planner.settings, "lift", desk.lift += desk.isRising ? 2.01 : -2);
    else assign(desk.choices.effects[4].plugin.settings, "youngs_modulus", desk.modulus = desk.modulus == 20 ? 24 : 20);
    const auto r = desk.after(true);
    if (!r->isLive) state.SkipWithError(("not live: " + r->error).c_str());
    state.SetIterationTime(r->liveMs / 1000);
    sum += r->motionValue() ? r->motionValue()->forceEvaluations : 0;
    beside += r->liveMs - r->solveMs;
  }
  const auto r = desk.worker.results();
  state.counters["points"] = r->sceneValue() ? r->sceneValue()->points() : 0;
  state.counters["force_evaluations"] = sum / double(state.iterations());
  state.counters["beside_solver_ms"] = beside / double(state.iterations());
}

// A hand that moves the bar sixty times a second by a tenth of a millimetre: how often it sees another skin.
void hand(benchmark::State& state) {
  Desk& desk = Desk::of(double(state.range(0)) / 100, false);
  constexpr int kMoves = 120;
  double skins = 0;
  for (auto _ : state) {
    auto last = desk.worker.results()->skin;
    for (int i = 0; i < kMoves; ++i) {
      assign(desk.choices.planner.settings, "lift", desk.lift += i < kMoves / 2 ? 0.1 : -0.1);
      desk.worker.want(desk.choices, true);
      for (int k = 0; k < 4; ++k) {
        std::this_thread::sleep_for(std::chrono::microseconds(16667 / 4));
        const auto now = desk.worker.results()->skin;
        skins += now != last;
        last = now;
      }
    }
    while (desk.worker.activity().isBusy) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const auto r = desk.worker.results();
  state.counters["points"] = r->sceneValue() ? r->sceneValue()->points() : 0;
  state.counters["skins_a_second"] = skins * 60 / (kMoves * double(state.iterations()));
}

void barMoves(benchmark::State& state) { follow(state, true, false); }
void barMovesInContact(benchmark::State& state) { follow(state, true, true); }
void stiffnessMoves(benchmark::State& state) { follow(state, false, false); }

}  // namespace

BENCHMARK(drawing)->ArgName("fine")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(updating)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(barMoves)->ArgName("hundredths_mm")->Arg(1000)->Arg(400)->Arg(177)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(24);
BENCHMARK(barMovesInContact)->ArgName("hundredths_mm")->Arg(1000)->Arg(400)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(24);
BENCHMARK(stiffnessMoves)->ArgName("hundredths_mm")->Arg(1000)->Arg(400)->Arg(177)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(10);
BENCHMARK(hand)->ArgName("hundredths_mm")->Arg(1000)->Arg(400)->Arg(177)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(1);
BENCHMARK_MAIN();
