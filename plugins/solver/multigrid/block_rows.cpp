#include "plugins/solver/multigrid/block_rows.h"

namespace pectora {

PECTORA_WIDE void addBlockProducts(std::size_t count, BlockRow a, bool transposed, ConstRow<float> in, Row<float> out) {
  const std::size_t s = a.stride, lower = transposed ? 1 : 3, upper = transposed ? 3 : 1;   // of entry (i, j): i lower + j upper
  const float *x = in.x, *y = in.y, *z = in.z;
  const float *xx = a.entries, *xy = xx + upper * s, *xz = xx + 2 * upper * s;
  const float *yx = xx + lower * s, *yy = yx + upper * s, *yz = yx + 2 * upper * s;
  const float *zx = xx + 2 * lower * s, *zy = zx + upper * s, *zz = zx + 2 * upper * s;
  float *px = out.x, *py = out.y, *pz = out.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    px[i] += xx[i] * x[i] + xy[i] * y[i] + xz[i] * z[i];
    py[i] += yx[i] * x[i] + yy[i] * y[i] + yz[i] * z[i];
    pz[i] += zx[i] * x[i] + zy[i] * y[i] + zz[i] * z[i];
  }
}

PECTORA_WIDE void addBlockProducts(std::size_t count, BlockRow a, ConstRow<float> nearIn, ConstRow<float> farIn, Row<float> nearOut, Row<float> farOut) {
  const std::size_t s = a.stride;
  const float *xx = a.entries, *xy = xx + s, *xz = xx + 2 * s, *yx = xx + 3 * s, *yy = xx + 4 * s, *yz = xx + 5 * s, *zx = xx + 6 * s,
              *zy = xx + 7 * s, *zz = xx + 8 * s;
  const float *nx = nearIn.x, *ny = nearIn.y, *nz = nearIn.z, *fx = farIn.x, *fy = farIn.y, *fz = farIn.z;
  float *px = nearOut.x, *py = nearOut.y, *pz = nearOut.z, *qx = farOut.x, *qy = farOut.y, *qz = farOut.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float u = nx[i], v = ny[i], w = nz[i], x = fx[i], y = fy[i], z = fz[i];
    px[i] += xx[i] * x + xy[i] * y + xz[i] * z;
    py[i] += yx[i] * x + yy[i] * y + yz[i] * z;
    pz[i] += zx[i] * x + zy[i] * y + zz[i] * z;
    qx[i] += xx[i] * u + yx[i] * v + zx[i] * w;
    qy[i] += xy[i] * u + yy[i] * v + zy[i] * w;
    qz[i] += xz[i] * u + yz[i] * v + zz[i] * w;
  }
}

PECTORA_WIDE void addScaled(std::size_t count, const float* from, float weight, float* to) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

PECTORA_WIDE void addEverySecond(std::size_t count, const float* from, float weight, float* to) {
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[2 * i];
}

PECTORA_WIDE void setSymmetricProducts(std::size_t count, BlockRow a, ConstRow<float> in, Row<float> out) {
  const std::size_t s = a.stride;
  const float *x = in.x, *y = in.y, *z = in.z;
  const float *xx = a.entries, *xy = xx + s, *xz = xx + 2 * s, *yy = xx + 3 * s, *yz = xx + 4 * s, *zz = xx + 5 * s;
  float *px = out.x, *py = out.y, *pz = out.z;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const float u = x[i], v = y[i], w = z[i];
    px[i] = xx[i] * u + xy[i] * v + xz[i] * w;
    py[i] = xy[i] * u + yy[i] * v + yz[i] * w;
    pz[i] = xz[i] * u + yz[i] * v + zz[i] * w;
  }
}

}  // namespace pectora
