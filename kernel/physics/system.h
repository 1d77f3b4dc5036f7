// The problem that a scene compiles to: free nodes, driven nodes, and energy terms over them.
#pragma once

#include "kernel/value/vec3.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pectora {

/// One vector a node, as structure of arrays. Nodes are numbered layer by layer from skin to pleura, then the anchors, then
/// the guides of effects.
struct NodeVectors {
  std::vector<double> x, y, z;

  NodeVectors() = default;
  explicit NodeVectors(std::size_t nodes) : x(nodes), y(nodes), z(nodes) {}
  std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3 v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  void add(std::size_t i, Vec3 v) { x[i] += v.x, y[i] += v.y, z[i] += v.z; }
  void append(Vec3 v) { x.push_back(v.x), y.push_back(v.y), z.push_back(v.z); }
  void clear();
};

/// The same in single precision, for what only steers a solver.
struct SingleVectors {
  std::vector<float> x, y, z;

  explicit SingleVectors(std::size_t nodes = 0) : x(nodes), y(nodes), z(nodes) {}
  std::size_t size() const { return x.size(); }
  Vec3 operator[](std::size_t i) const { return {double(x[i]), double(y[i]), double(z[i])}; }
  void set(std::size_t i, Vec3 v) { x[i] = float(v.x), y[i] = float(v.y), z[i] = float(v.z); }
  void clear();
};

class Hessian;

/// How right forces are to be: to the last digits, or to about 1e-5 of the largest one.
enum class Precision { full, rough };

/// A spring between two nodes: energy 1/2 k (l - l0)^2, with k multiplied by `compression` while l < l0.
struct Spring {
  std::size_t a = 0, b = 0;
  double stiffnessNPerMm = 0, restLength = 0, compression = 1;
};

/// One term of the potential energy, in N mm.
class Term {
 public:
  virtual ~Term() = default;
  /// The effects that it stands for, for messages: "stretch, shear".
  virtual std::string name() const = 0;
  virtual double energy(const NodeVectors& positions) const = 0;
  /// Returns the energy and adds its gradient (N) to `gradient`. The gradient of driven nodes
  /// means nothing. Also raises `largestForce` to the largest force of a
  /// single spring or element, the scale of the residual. The result does not depend on the number of threads.
  virtual double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const = 0;
  /// The same with errors of up to about 1e-5 of the largest force, if that is faster: in single precision.
  virtual double evaluateRoughly(const NodeVectors& positions, NodeVectors& gradient, double& largestForce) const {
    return evaluate(positions, gradient, largestForce);
  }
  /// Adds to each node a bound of its stiffness: the sum over its springs of 2 k, or k where the other end is driven
  /// (science: Gershgorin bound of the Hessian's rows), N/mm.
  virtual void addStiffnessBound(std::vector<double>& bound) const = 0;

  /// False for a term that may be without force wherever a point is, such as contact: it keeps nothing in its place.
  virtual bool holds() const { return true; }

  /// Offers, for solvers that need more than a gradient. Each comes with a word on whether it is there, so that a solver
  /// can be refused before any work.
  virtual bool hasHessian() const { return false; }
  /// The second derivative, not yet taken anywhere. The term must outlive it. Null without one.
  virtual std::unique_ptr<Hessian> makeHessian() const;
  /// True if the term is nothing but springs, or forces that never change.
  virtual bool hasSprings() const { return false; }
  /// Calls `visit` for each of them, always in one order.
  virtual void forEachSpring(const std::function<void(const Spring&)>& /*visit*/) const {}
};

/// How a wall is to be followed in time, from rest: a = F / m - c v of every free node.
struct Dynamics {
  double duration = 0;   ///< s; 0: nothing is asked for but the shape at rest
  double lifting = 0;    ///< s from the beginning that the driven nodes take, starting and stopping softly
  double interval = 0;   ///< s between the moments that are kept
  double damping = 0;    ///< c, 1/s
  bool isAskedFor() const { return duration > 0; }
};

/// Nodes [0, freeNodes) are unknown, the rest follow the plan.
struct System {
  int rows = 0, columns = 0;               ///< of each layer
  int layers = 2;                          ///< skin, those between, pleura
  std::size_t freeNodes = 0;
  NodeVectors rest;                        ///< all nodes, mm
  std::vector<double> mass;                ///< of the free nodes, kg
  std::vector<std::unique_ptr<Term>> terms;
  Dynamics dynamics;

  /// Points of one layer; point (r, c) is r * columns + c.
  std::size_t points() const { return std::size_t(rows) * columns; }
  /// The node of a point of layer l, 0 the skin; and of an anchor.
  std::size_t node(int l, std::size_t point) const { return std::size_t(l) * points() + point; }
  std::size_t anchorNode(std::size_t anchor) const { return node(layers, anchor); }
  /// Energy of all terms; overwrites `gradient` of the free nodes.
  double evaluate(const NodeVectors& positions, NodeVectors& gradient, double& largestForce, Precision precision = Precision::full) const;
  double energy(const NodeVectors& positions) const;
  std::vector<double> stiffnessBound() const;
  /// "skin point at row 3, column 17", for messages.
  std::string nodeName(std::size_t node) const;
};

/// Where the driven nodes lie after part t of the motion, 0 to 1: linear between equally spaced frames.
struct Drive {
  std::vector<std::vector<Vec3>> frames;
  /// Writes them into the tail of `positions`.
  void apply(double t, std::size_t freeNodes, NodeVectors& positions) const;
};

}  // namespace pectora
