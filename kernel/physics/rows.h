// Rows of vectors, as the inner loops take them, and how such loops are compiled for wide registers.
#pragma once

#include "kernel/physics/system.h"

/// One copy of a loop for each width of registers, chosen when the program is loaded. (Sanitizers do not survive the choice.)
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PECTORA_WIDE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PECTORA_WIDE
#endif
/// What such loops call, so that it is compiled with them.
#define PECTORA_INLINE static inline __attribute__((always_inline))

namespace pectora {

template <class T>
struct ConstRow {
  const T *x, *y, *z;
};
template <class T>
struct Row {
  T *x, *y, *z;
};

/// The vectors from `i` on, and the same to be read only.
template <class T>
Row<T> at(Row<T> row, std::size_t i) { return {row.x + i, row.y + i, row.z + i}; }
template <class T>
ConstRow<T> constant(Row<T> row) { return {row.x, row.y, row.z}; }

/// The vectors from `node` on.
inline ConstRow<double> rowOf(const NodeVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }
inline Row<double> rowOf(NodeVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }
inline ConstRow<float> rowOf(const SingleVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }
inline Row<float> rowOf(SingleVectors& v, std::size_t node) { return {&v.x[node], &v.y[node], &v.z[node]}; }

}  // namespace pectora
