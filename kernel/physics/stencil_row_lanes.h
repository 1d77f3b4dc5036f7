// The body of stencil_row.cpp, which includes it once for each instruction set, within a namespace that says how many numbers a register
// has (W). Compilers choose instructions where vectors are written down, not where functions are inlined.

// One register of W numbers, and of W answers.
typedef float Floats __attribute__((vector_size(4 * W)));
typedef int Answers __attribute__((vector_size(4 * W)));

PECTORA_INLINE Floats load(const float* from) {
  Floats v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
PECTORA_INLINE void store(Floats v, float* to) { std::memcpy(to, &v, sizeof v); }
PECTORA_INLINE Floats root(Floats v) {
  for (int i = 0; i < W; ++i) v[i] = std::sqrt(v[i]);
  return v;
}

struct Triple {
  Floats x, y, z;
};
PECTORA_INLINE Triple load(ConstRow<float> row, std::ptrdiff_t i) { return {load(row.x + i), load(row.y + i), load(row.z + i)}; }

// A chunk of columns is done register by register, but spring by spring: so sums have one order whatever a register holds.
bool addForces(const StencilRow& a) {
  constexpr int kParts = int(kChunk) / W;
  Answers degenerate{}, lane;
  for (int i = 0; i < W; ++i) lane[i] = i;
  for (std::ptrdiff_t chunk = 0; chunk < std::ptrdiff_t(a.columns); chunk += std::ptrdiff_t(kChunk)) {
    Triple near[kParts], nearAtRest[kParts], pull[kParts];
    Floats twice[kParts], largest[kParts];
    for (int part = 0; part < kParts; ++part) {
      const std::ptrdiff_t i = chunk + part * W;
      near[part] = load(a.moved, i), nearAtRest[part] = load(a.rest, i), pull[part] = Triple{};
      twice[part] = load(a.twiceEnergy + i), largest[part] = load(a.largestSquared + i);
    }
    for (const RowEntry* entry = a.entries; entry != a.entriesEnd; ++entry) {
      const bool isWhole = entry->first <= chunk && chunk + std::ptrdiff_t(kChunk) <= entry->end;
      for (int part = 0; part < kParts; ++part) {
        const std::ptrdiff_t i = chunk + part * W, f = i + entry->far;
        const Triple far = load(a.moved, f), farAtRest = load(a.rest, f);
        const Floats ux = far.x - near[part].x, uy = far.y - near[part].y, uz = far.z - near[part].z;
        const Floats x0 = farAtRest.x - nearAtRest[part].x, y0 = farAtRest.y - nearAtRest[part].y, z0 = farAtRest.z - nearAtRest[part].z;
        const Floats x = x0 + ux, y = y0 + uy, z = z0 + uz;
        const Floats squared = x * x + y * y + z * z, squared0 = x0 * x0 + y0 * y0 + z0 * z0;
        // l^2 - l0^2 without loss of digits; then 1 - l0 / l = growth / (l^2 + l l0), and (l - l0)^2 = growth^2 / (l + l0)^2.
        const Floats growth = ux * (x + x0) + uy * (y + y0) + uz * (z + z0);
        Floats k = growth < 0 ? Floats{} + entry->compressed : Floats{} + entry->stretched;
        Answers isDegenerate = squared <= kDegenerateSingle * kDegenerateSingle * squared0;
        if (!isWhole) {
          const Answers isThere = (lane >= int(entry->first - i)) & (lane < int(entry->end - i));
          k = isThere ? k : Floats{};
          isDegenerate &= isThere;
        }
        degenerate |= isDegenerate;
        const Floats product = root(squared * squared0);
        const Floats below = squared + product, sum = squared + squared0 + 2 * product;
        const Floats share = k * growth / (below * sum), scale = share * sum, energy = share * growth * below;
        const Floats px = scale * x, py = scale * y, pz = scale * z;
        pull[part].x += px, pull[part].y += py, pull[part].z += pz;
        store(load(a.gradient.x + f) + px, a.gradient.x + f);
        store(load(a.gradient.y + f) + py, a.gradient.y + f);
        store(load(a.gradient.z + f) + pz, a.gradient.z + f);
        twice[part] += energy;
        const Floats size = k * energy;
        largest[part] = largest[part] < size ? size : largest[part];
      }
    }
    for (int part = 0; part < kParts; ++part) {
      const std::ptrdiff_t i = chunk + part * W;
      store(load(a.gradient.x + i) - pull[part].x, a.gradient.x + i);
      store(load(a.gradient.y + i) - pull[part].y, a.gradient.y + i);
      store(load(a.gradient.z + i) - pull[part].z, a.gradient.z + i);
      store(twice[part], a.twiceEnergy + i), store(largest[part], a.largestSquared + i);
    }
  }
  int any = 0;
  for (int i = 0; i < W; ++i) any |= degenerate[i];
  return any != 0;
}
