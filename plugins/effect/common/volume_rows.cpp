#include "plugins/effect/common/volume_rows.h"

namespace pectora::cells {
namespace {

// The volume of left-handed corners is less than nothing.
constexpr double kShare = -1.0 / 12;

template <class T>
struct Triple {
  T x, y, z;
};
template <class T>
PECTORA_INLINE Triple<T> operator+(Triple<T> a, Triple<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T>
PECTORA_INLINE Triple<T> operator-(Triple<T> a, Triple<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T>
PECTORA_INLINE Triple<T> operator*(T s, Triple<T> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T>
PECTORA_INLINE T dot(Triple<T> a, Triple<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T>
PECTORA_INLINE Triple<T> cross(Triple<T> a, Triple<T> b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

template <class T>
struct OnDiagonals {
  Triple<T> p, q, r, s, t, u;
};
template <class T>
PECTORA_INLINE T dot(const OnDiagonals<T>& a, const OnDiagonals<T>& b) {
  return dot(a.p, b.p) + dot(a.q, b.q) + dot(a.r, b.r) + dot(a.s, b.s) + dot(a.t, b.t) + dot(a.u, b.u);
}
template <class T>
PECTORA_INLINE OnDiagonals<T> operator*(T s, const OnDiagonals<T>& a) { return {s * a.p, s * a.q, s * a.r, s * a.s, s * a.t, s * a.u}; }

template <class T>
PECTORA_INLINE OnDiagonals<double> differences(const CornerRow<T>& x, std::size_t i) {
  const auto at = [&](int corner) {
    const ConstRow<T>& row = x.rows[corner >> 1];
    const std::size_t c = i + std::size_t(corner & 1);
    return Triple<double>{double(row.x[c]), double(row.y[c]), double(row.z[c])};
  };
  const auto x0 = at(0), x7 = at(7);
  return {at(6) - x0, x7 - at(1), x7 - at(2), at(5) - x0, x7 - at(4), at(3) - x0};
}

// Derivatives of 12 V by the diagonals.
PECTORA_INLINE OnDiagonals<double> derivativesOf(const OnDiagonals<double>& d) {
  const auto qp = d.q + d.p, rs = d.r + d.s, tu = d.t + d.u;
  const auto ru = cross(d.r, d.u), tp = cross(d.t, d.p), qs = cross(d.q, d.s);
  return {ru + cross(rs, d.t), ru + cross(d.s, tu), cross(d.u, qp) + tp, tp + cross(tu, d.q), cross(d.p, rs) + qs, cross(qp, d.r) + qs};
}

// How they change when the diagonals change by v.
PECTORA_INLINE OnDiagonals<double> changesOf(const OnDiagonals<double>& d, const OnDiagonals<double>& v) {
  const auto both = [](auto a, auto da, auto b, auto db) { return cross(da, b) + cross(a, db); };
  const auto qp = d.q + d.p, rs = d.r + d.s, tu = d.t + d.u, vqp = v.q + v.p, vrs = v.r + v.s, vtu = v.t + v.u;
  const auto ru = both(d.r, v.r, d.u, v.u), tp = both(d.t, v.t, d.p, v.p), qs = both(d.q, v.q, d.s, v.s);
  return {ru + both(rs, vrs, d.t, v.t), ru + both(d.s, v.s, tu, vtu), both(d.u, v.u, qp, vqp) + tp,
          tp + both(tu, vtu, d.q, v.q), both(d.p, v.p, rs, vrs) + qs,   both(qp, vqp, d.r, v.r) + qs};
}

template <class T>
PECTORA_INLINE void store(const OnDiagonals<double>& d, CellNumbers<T> to, std::size_t i) {
  const Triple<double> all[kDiagonals] = {d.p, d.q, d.r, d.s, d.t, d.u};
  for (int n = 0; n < kDiagonals; ++n) to.row(3 * n)[i] = T(all[n].x), to.row(3 * n + 1)[i] = T(all[n].y), to.row(3 * n + 2)[i] = T(all[n].z);
}
template <class T>
PECTORA_INLINE OnDiagonals<double> load(CellNumbers<T> from, std::size_t i) {
  const auto at = [&](int n) { return Triple<double>{double(from.row(3 * n)[i]), double(from.row(3 * n + 1)[i]), double(from.row(3 * n + 2)[i])}; };
  return {at(0), at(1), at(2), at(3), at(4), at(5)};
}

template <class T>
PECTORA_INLINE void addToCornersOf(std::size_t count, CellNumbers<double> numbers, const Row<T> (&rows)[4]) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto of = [axis](const Row<T>& row) { return axis == 0 ? row.x : axis == 1 ? row.y : row.z; };
    const double *p = numbers.row(axis), *q = numbers.row(3 + axis), *r = numbers.row(6 + axis), *s = numbers.row(9 + axis),
                 *t = numbers.row(12 + axis), *u = numbers.row(15 + axis);
    T *a = of(rows[0]), *b = of(rows[1]), *c = of(rows[2]), *d = of(rows[3]);
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) a[i] -= T(p[i] + s[i] + u[i]), b[i] -= T(r[i]), c[i] -= T(t[i]), d[i] += T(p[i]);
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) a[i + 1] -= T(q[i]), b[i + 1] += T(u[i]), c[i + 1] += T(s[i]), d[i + 1] += T(q[i] + r[i] + t[i]);
  }
}

template <class T>
PECTORA_INLINE void projectOntoOf(std::size_t count, CellNumbers<const float> g, const CornerRow<T>& v, CellNumbers<double> numbers) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const OnDiagonals<double> direction = load(g, i);
    store(dot(direction, differences(v, i)) * direction, numbers, i);
  }
}

template <class T>
PECTORA_INLINE void addTurnedOf(std::size_t count, const float* pressure, CellNumbers<const float> diagonals, const CornerRow<T>& v,
                                CellNumbers<double> numbers) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const OnDiagonals<double> d = kShare * double(pressure[i]) * changesOf(load(diagonals, i), differences(v, i)), n = load(numbers, i);
    store({n.p + d.p, n.q + d.q, n.r + d.r, n.s + d.s, n.t + d.t, n.u + d.u}, numbers, i);
  }
}

PECTORA_INLINE double larger(double a, double b) { return a < b ? b : a; }

}  // namespace

PECTORA_WIDE void volumes(std::size_t count, const CornerRow<double>& x, double* volume, CellNumbers<double> derivatives) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const OnDiagonals<double> d = differences(x, i), g = kShare * derivativesOf(d);
    volume[i] = dot(d, g) / 3;   // of third degree (Euler)
    store(g, derivatives, i);
  }
}

PECTORA_WIDE void press(std::size_t count, const CornerRow<double>& x, const PressedRow& row, CellNumbers<double> forces) {
  const double *restVolume = row.restVolume, *stiffness = row.stiffness;
  double *twice = row.twiceEnergy, *largest = row.largestSquared;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const OnDiagonals<double> d = differences(x, i), g = kShare * derivativesOf(d);
    const double grown = dot(d, g) / 3 - restVolume[i], pressure = stiffness[i] * grown;
    const OnDiagonals<double> f = pressure * g;
    store(f, forces, i);
    twice[i] += pressure * grown;
    const auto first = f.p + f.s + f.u, last = f.q + f.r + f.t;
    const double squared = larger(larger(larger(dot(first, first), dot(last, last)), larger(dot(f.p, f.p), dot(f.q, f.q))),
                                  larger(larger(dot(f.r, f.r), dot(f.s, f.s)), larger(dot(f.t, f.t), dot(f.u, f.u))));
    largest[i] = larger(largest[i], squared);
  }
}

PECTORA_WIDE void addToCorners(std::size_t count, CellNumbers<double> numbers, const Row<double> (&rows)[4]) { addToCornersOf(count, numbers, rows); }
PECTORA_WIDE void addToCorners(std::size_t count, CellNumbers<double> numbers, const Row<float> (&rows)[4]) { addToCornersOf(count, numbers, rows); }

PECTORA_WIDE void projectOnto(std::size_t count, CellNumbers<const float> g, const CornerRow<double>& v, CellNumbers<double> numbers) {
  projectOntoOf(count, g, v, numbers);
}
PECTORA_WIDE void projectOnto(std::size_t count, CellNumbers<const float> g, const CornerRow<float>& v, CellNumbers<double> numbers) {
  projectOntoOf(count, g, v, numbers);
}

PECTORA_WIDE void addTurned(std::size_t count, const float* pressure, CellNumbers<const float> diagonals, const CornerRow<double>& v, CellNumbers<double> numbers) {
  addTurnedOf(count, pressure, diagonals, v, numbers);
}
PECTORA_WIDE void addTurned(std::size_t count, const float* pressure, CellNumbers<const float> diagonals, const CornerRow<float>& v, CellNumbers<double> numbers) {
  addTurnedOf(count, pressure, diagonals, v, numbers);
}

PECTORA_WIDE void diagonalsOf(std::size_t count, const CornerRow<double>& x, CellNumbers<float> diagonals) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) store(differences(x, i), diagonals, i);
}

}  // namespace pectora::cells
