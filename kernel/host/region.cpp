#include "kernel/host/region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

// A region that grows is the whole at the latest after so many times.
constexpr int kMostTimes = 50;

template <class T>
std::vector<T> cropped(const std::vector<T>& all, int columns, const Region& r) {
  std::vector<T> part;
  for (int row = r.firstRow; row < r.endRow; ++row)
    part.insert(part.end(), all.begin() + row * columns + r.firstColumn, all.begin() + row * columns + r.endColumn);
  return part;
}

// Shows what a part does as what the whole does.
class PartHost final : public Host {
 public:
  PartHost(Host& host, std::function<void(const NodeVectors&)> show) : host_(host), show_(std::move(show)) {}
  void progress(double fraction, const std::string& what) override { host_.progress(fraction, what); }
  bool cancelled() const override { return host_.cancelled(); }
  void warn(const std::string& message) override { host_.warn(message); }
  void info(const std::string& message) override { host_.info(message); }
  void preview(const NodeVectors& positions) override { show_(positions); }
  std::string pluginFolder() const override { return host_.pluginFolder(); }

 private:
  Host& host_;
  std::function<void(const NodeVectors&)> show_;
};

}  // namespace

std::shared_ptr<const Scene> crop(const Scene& scene, const Region& r, std::vector<std::size_t>& anchors) {
  auto part = std::make_shared<Scene>(scene);
  part->rows = r.endRow - r.firstRow;
  part->columns = r.endColumn - r.firstColumn;
  part->outer = cropped(scene.outer, scene.columns, r);
  part->inner = cropped(scene.inner, scene.columns, r);
  part->outerMass = cropped(scene.outerMass, scene.columns, r);
  part->innerMass = cropped(scene.innerMass, scene.columns, r);
  for (std::size_t l = 0; l < scene.between.size(); ++l) {
    part->between[l] = cropped(scene.between[l], scene.columns, r);
    part->betweenMass[l] = cropped(scene.betweenMass[l], scene.columns, r);
  }
  if (!scene.cellTissue.empty()) {
    part->cellTissue.resize(std::size_t(part->cells()));
    for (int l = 0; l + 1 < scene.layers(); ++l)
      for (int row = 0; row + 1 < part->rows; ++row)
        for (int column = 0; column + 1 < part->columns; ++column)
          part->cellTissue[std::size_t(part->cell(l, row, column))] = scene.cellTissue[std::size_t(scene.cell(l, r.firstRow + row, r.firstColumn + column))];
  }
  part->anchors.clear();
  anchors.clear();
  for (std::size_t j = 0; j < scene.anchors.size(); ++j) {
    Anchor anchor = scene.anchors[j];
    const int row = anchor.point / scene.columns - r.firstRow, column = anchor.point % scene.columns - r.firstColumn;
    if (row < 0 || row >= part->rows || column < 0 || column >= part->columns) continue;
    anchor.point = part->index(row, column);
    part->anchors.push_back(anchor);
    anchors.push_back(j);
  }
  return part;
}

Region RegionSolve::wider(Region r, bool low, bool high, bool right, bool left) const {
  const int rows = std::max(1, int(std::ceil(scene_.thickness / scene_.rowSpacing)));
  const int columns = std::max(1, int(std::ceil(scene_.thickness / scene_.columnSpacing)));
  if (low) r.firstRow = std::max(0, r.firstRow - rows);
  if (high) r.endRow = std::min(scene_.rows, r.endRow + rows);
  if (right) r.firstColumn = std::max(0, r.firstColumn - columns);
  if (left) r.endColumn = std::min(scene_.columns, r.endColumn + columns);
  return r;
}

Region RegionSolve::movedBy(const Drive& drive) const {
  Region r = part_ ? region_ : Region{scene_.rows, 0, scene_.columns, 0};
  for (std::size_t j = 0; j < scene_.anchors.size(); ++j) {
    if (distance(drive.frames.back()[j], scene_.anchors[j].rest) <= still_) continue;
    const int row = scene_.anchors[j].point / scene_.columns, column = scene_.anchors[j].point % scene_.columns;
    const Region around = wider({row, row + 1, column, column + 1}, true, true, true, true);
    r = {std::min(r.firstRow, around.firstRow), std::max(r.endRow, around.endRow), std::min(r.firstColumn, around.firstColumn),
         std::max(r.endColumn, around.endColumn)};
  }
  return r;
}

void RegionSolve::prepare(const Region& region, Host& host) {
  if (part_ && region == region_) return;
  session_.reset();
  part_ = crop(scene_, region, anchors_);
  compiled_ = compile(*part_, registry_);
  session_ = solver_.prepare(*compiled_.system, host);
  region_ = region;
}

std::size_t RegionSolve::wholeNode(std::size_t node) const {
  const System& part = *compiled_.system;
  const std::size_t layer = node / part.points(), point = node % part.points();
  const int row = region_.firstRow + int(point) / part.columns, column = region_.firstColumn + int(point) % part.columns;
  return whole_.node(int(layer), std::size_t(scene_.index(row, column)));
}

NodeVectors RegionSolve::cut(const NodeVectors& positions, const Drive& drive) const {
  const System& part = *compiled_.system;
  NodeVectors result(part.rest.size());
  for (std::size_t i = 0; i < part.freeNodes; ++i) result.set(i, positions[wholeNode(i)]);
  for (std::size_t j = 0; j < anchors_.size(); ++j) result.set(part.anchorNode(j), positions[whole_.anchorNode(anchors_[j])]);
  // An effect's guides are the part's own.
  for (std::size_t i = part.anchorNode(anchors_.size()); i < result.size(); ++i) result.set(i, drive.frames.back()[i - part.freeNodes]);
  return result;
}

void RegionSolve::paste(const NodeVectors& part, NodeVectors& positions) const {
  for (std::size_t i = 0; i < compiled_.system->freeNodes; ++i) positions.set(wholeNode(i), part[i]);
}

Solution RegionSolve::solve(const Plan& plan, const Drive& drive, const NodeVectors* start, Host& host) {
  // All stand still but what is solved for, and what is driven.
  NodeVectors positions = whole_.rest;
  drive.apply(1, whole_.freeNodes, positions);
  const Region moved = movedBy(drive);
  Solution solution;
  if (moved.endRow <= moved.firstRow) {
    solution.positions = std::move(positions);
    solution.status = SolveStatus::converged;
    return solution;
  }
  prepare(moved, host);
  NodeVectors from = start ? *start : NodeVectors();
  for (int time = 0; time < kMostTimes; ++time) {
    const Drive partDrive = from.size() ? makeDriveEnd(*part_, compiled_, plan) : makeDrive(*part_, compiled_, plan);
    const NodeVectors partStart = from.size() ? cut(from, partDrive) : NodeVectors();
    PartHost partHost(host, [&](const NodeVectors& part) {
      paste(part, positions);
      host.preview(positions);
    });
    Solution now = session_->solve(partDrive, from.size() ? &partStart : nullptr, partHost);
    now.iterations += solution.iterations;
    now.forceEvaluations += solution.forceEvaluations;
    paste(now.positions, positions);
    solution = std::move(now);

    // A side that moves, though the wall goes on beyond it, is too near.
    const System& part = *compiled_.system;
    const auto goes = [&](int row, int column) {
      for (int l = 0; l < part.layers; ++l) {
        const std::size_t node = part.node(l, std::size_t(row * part.columns + column));
        if (distance(solution.positions[node], part.rest[node]) > still_) return true;
      }
      return false;
    };
    bool low = false, high = false, right = false, left = false;
    for (int column = 0; column < part.columns; ++column) low |= goes(0, column), high |= goes(part.rows - 1, column);
    for (int row = 0; row < part.rows; ++row) right |= goes(row, 0), left |= goes(row, part.columns - 1);
    const Region next = wider(region_, low, high, right, left);
    if (next == region_) break;
    from = positions;
    prepare(next, host);
  }
  host.info(fmt::format("{} of {} points are computed; the others go less than {:g} mm", region_.points(), scene_.points(), still_));
  solution.positions = std::move(positions);
  return solution;
}

}  // namespace pectora
