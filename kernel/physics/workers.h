// The threads of the process. Two rules keep results independent of their number: work is cut into pieces whose
// count never depends on it, and sums over pieces are taken in the order of the pieces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace pectora {

/// How many threads parallelFor may use, at least 1. Set once at the start; the default is the machine's.
void setThreads(int count);
int threads();

/// Calls body(0) ... body(count - 1), each once, in any order, on up to threads() threads.
/// The first exception thrown by a body is rethrown here.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

/// How many pieces of `length` there are in `count`, the last one perhaps shorter.
inline std::size_t piecesOf(std::size_t count, std::size_t length) { return (count + length - 1) / length; }
/// Calls body(piece, begin, end) for each of them, as parallelFor does.
template <class F>
void forEachPiece(std::size_t count, std::size_t length, F&& body) {
  parallelFor(piecesOf(count, length), [&](std::size_t piece) { body(piece, piece * length, std::min(count, (piece + 1) * length)); });
}

}  // namespace pectora
