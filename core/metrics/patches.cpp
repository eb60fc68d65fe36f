#include "core/metrics/patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/numeric/principal_components.h"

namespace terrazzo {

namespace {

constexpr size_t learnt_patches = 20000;  ///< patches from which the components are learnt
constexpr int lane = 8;                   ///< outputs computed at once
constexpr int at_once = 4;                ///< patches computed at once

void gather(const Planes& image, uint32_t patch, int step, const std::vector<float>& mean, float* out) {
  const int across = patch_positions(image.size, step).width, channels = image.channels;
  const int x = int(patch % uint32_t(across)), y = int(patch / uint32_t(across));
  const int run = step == 1 ? patch_side * channels : channels, runs = patch_side * channels / run;
  const float* subtracted = mean.data();
  for (int dy = 0; dy < patch_side; dy++)
    for (int k = 0; k < runs; k++) {
      const float* from = image.at(x + k * step, y + dy * step);
      for (int i = 0; i < run; i++) *out++ = from[i] - *subtracted++;
    }
}

/// `at_once` patches (rows of `inputs` values) times all weights.
void multiply(const float* patches, const Projection& p, float* const* out) {
  for (int first = 0; first < p.outputs; first += lane) {
    float sum[at_once][lane] = {};
    const float* weights = &p.weights[first];
    for (int i = 0; i < p.inputs; i++, weights += p.outputs)
      for (int s = 0; s < at_once; s++) {
        const float v = patches[size_t(s) * p.inputs + i];
        for (int k = 0; k < lane; k++) sum[s][k] += v * weights[k];
      }
    for (int s = 0; s < at_once; s++) std::copy_n(sum[s], lane, out[s] + first);
  }
}

}  // namespace

Size patch_positions(Size image, int step) {
  const int reach = (patch_side - 1) * step;
  return {image.width - reach, image.height - reach};
}

Planes with_windows_across(const Planes& image, int step) {
  const int by = (patch_side - 1) * step;
  Planes out = Planes::zeros({image.size.width + by, image.size.height + by}, image.channels);
  for (int y = 0; y < out.size.height; y++)
    for (int x = 0; x < out.size.width; x++)
      std::copy_n(image.at(image.column(x), image.row(y)), image.channels, out.at(x, y));
  return out;
}

PatchList all_patches(Size image, int step) {
  PatchList out(size_t(patch_positions(image, step).area()));
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

PatchList random_patches(Size image, size_t count, uint64_t seed, int step) {
  PatchList out = all_patches(image, step);
  count = std::min(count, out.size());
  for (size_t i = 0; i < count; i++) {
    const uint32_t left = uint32_t(out.size() - i);
    std::swap(out[i], out[i + below(uint32_t(random_bits(seed, i)), left)]);
  }
  out.resize(count);
  return out;
}

Projection principal_projection(const Planes& image, const PatchList& patches, int outputs, const Task& task,
                                int step) {
  const int inputs = patch_values(image);
  const size_t count = std::min(patches.size(), learnt_patches);
  std::vector<float> rows(count * inputs);
  const std::vector<float> nothing(inputs);
  for (size_t i = 0; i < count; i++)
    gather(image, patches[i * patches.size() / count], step, nothing, &rows[i * inputs]);
  const PrincipalComponents pca = principal_components(rows, inputs, outputs, task);
  Projection p{inputs, outputs, step, pca.mean, std::vector<float>(size_t(inputs) * outputs)};
  for (size_t k = 0; k < pca.variances.size(); k++)
    for (int i = 0; i < inputs; i++) p.weights[size_t(i) * outputs + k] = pca.components[k * inputs + i];
  return p;
}

Projection random_directions(int inputs, int outputs, uint64_t seed) {
  Projection p{inputs, outputs, 1, std::vector<float>(inputs), std::vector<float>(size_t(inputs) * outputs)};
  std::vector<double> direction(inputs);
  for (int k = 0; k < outputs; k++) {
    double norm = 0;
    for (int i = 0; i < inputs; i++) {
      // A sum of twelve uniform numbers is as good as normal here, and needs no logarithm.
      double v = -6;
      for (int j = 0; j < 12; j++) v += unit_double(random_bits(seed, k, i, j));
      direction[i] = v;
      norm += v * v;
    }
    norm = std::sqrt(norm);
    for (int i = 0; i < inputs; i++) p.weights[size_t(i) * outputs + k] = float(direction[i] / norm);
  }
  return p;
}

std::vector<float> project(const Planes& image, const PatchList& patches, const Projection& p, const Task& task) {
  std::vector<float> out(patches.size() * p.outputs);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, patches.size(), 512), [&](const auto& range) {
    task.check();
    std::vector<float> gathered(size_t(at_once) * p.inputs), spare(p.outputs);
    for (size_t s = range.begin(); s < range.end(); s += at_once) {
      float* to[at_once];
      for (int i = 0; i < at_once; i++) {
        const bool real = s + i < range.end();
        to[i] = real ? &out[(s + i) * p.outputs] : spare.data();
        if (real) gather(image, patches[s + i], p.step, p.mean, &gathered[size_t(i) * p.inputs]);
      }
      multiply(gathered.data(), p, to);
    }
  });
  return out;
}

}  // namespace terrazzo
