#include "plugins/solver/xpbd/xpbd.h"

#include <algorithm>

namespace pectora {

Xpbd::Xpbd(const System& system, NodeVectors start)
    : system_(system), inverseMass_(system.rest.size()), force_(system.rest.size()), now_(std::move(start)), before_(now_), velocity_(now_.size()) {
  const std::vector<double> bound = system.stiffnessBound();
  for (std::size_t i = 0; i < system.freeNodes; ++i) inverseMass_[i] = 1 / bound[i];
  NodeVectors gradient(now_.size());
  for (const auto& term : system.terms) {
    const std::size_t count = springs_.size();
    term->forEachSpring([&](const Spring& s) { springs_.push_back(s); });
    if (springs_.size() > count) continue;
    double largest = 0;
    term->evaluate(now_, gradient, largest);
    for (std::size_t i = 0; i < system.freeNodes; ++i) force_.add(i, -gradient[i]);
    gradient.clear();
  }
}

void Xpbd::step(double h) {
  std::swap(before_, now_);
  now_ = before_;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) now_.add(i, velocity_[i] * h + force_[i] * (h * h * inverseMass_[i]));
  for (const Spring& s : springs_) {
    const Vec3 d = now_[s.b] - now_[s.a];
    const double length = norm(d), stretch = length - s.restLength;
    const double k = stretch < 0 ? s.stiffnessNPerMm * s.compression : s.stiffnessNPerMm;
    if (!(length > 1e-12 * s.restLength) || !(k > 0)) continue;   // without direction, or slack
    const double wa = inverseMass_[s.a], wb = inverseMass_[s.b];
    const Vec3 pull = d * (stretch / (length * (wa + wb + 1 / (k * h * h))));
    now_.add(s.a, pull * wa);
    now_.add(s.b, pull * -wb);
  }
  double kinetic = 0;
  for (std::size_t i = 0; i < system_.freeNodes; ++i) {
    velocity_.set(i, (now_[i] - before_[i]) / h);
    kinetic += 0.5 * dot(velocity_[i], velocity_[i]) / inverseMass_[i];
  }
  if (kinetic < kinetic_) {
    velocity_.clear();
    kinetic = 0;
  }
  kinetic_ = kinetic;
}

}  // namespace pectora
