#include "kernel/physics/system.h"

#include "kernel/physics/hessian.h"
#include "kernel/physics/workers.h"

#include <algorithm>

namespace pectora {

void SingleVectors::clear() {
  std::fill(x.begin(), x.end(), 0.0f);
  std::fill(y.begin(), y.end(), 0.0f);
  std::fill(z.begin(), z.end(), 0.0f);
}

void NodeVectors::clear() {
  std::fill(x.begin(), x.end(), 0.0);
  std::fill(y.begin(), y.end(), 0.0);
  std::fill(z.begin(), z.end(), 0.0);
}

std::unique_ptr<Hessian> Term::makeHessian() const { return nullptr; }

double System::evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce, Precision precision) const {
  // What terms add for driven nodes is never read.
  for (auto* v : {&gradient.x, &gradient.y, &gradient.z}) std::fill_n(v->begin(), freeNodes, 0.0);
  largestForce = 0;
  double total = 0;
  for (const auto& term : terms)
    total += precision == Precision::full ? term->evaluate(positions, gradient, largestForce) : term->evaluateRoughly(positions, gradient, largestForce);
  return total;
}

double System::energy(const NodeVectors& positions) const {
  double total = 0;
  for (const auto& term : terms) total += term->energy(positions);
  return total;
}

std::vector<double> System::stiffnessBound() const {
  std::vector<double> bound(rest.size(), 0.0);
  for (const auto& term : terms) term->addStiffnessBound(bound);
  bound.resize(freeNodes);
  return bound;
}

std::string System::nodeName(std::size_t node) const {
  if (node >= anchorNode(0)) return "anchor " + std::to_string(node - anchorNode(0));
  const std::size_t layer = node / points(), point = node % points();
  const std::string name = layer == 0 ? "skin point" : int(layer) == layers - 1 ? "pleura point" : "point of layer " + std::to_string(layer);
  return name + " at row " + std::to_string(point / columns) + ", column " + std::to_string(point % columns);
}

void Drive::apply(double t, std::size_t freeNodes, NodeVectors& positions) const {
  const double position = std::clamp(t, 0.0, 1.0) * double(frames.size() - 1);
  const std::size_t frame = std::min(frames.size() - 2, std::size_t(position));
  const std::vector<Vec3>&from = frames[frame], &to = frames[frame + 1];
  constexpr std::size_t kPiece = 4096;
  forEachPiece(from.size(), kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions.set(freeNodes + i, lerp(from[i], to[i], position - double(frame)));
  });
}

}  // namespace pectora
