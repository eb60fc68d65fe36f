#include "core/analysis/space/filter_bank.h"

#include <atomic>
#include <cmath>
#include <functional>

#include <tbb/parallel_for.h>

#include "core/base/portable_math.h"
#include "core/numeric/fft.h"
#include "core/numeric/gaussian.h"

namespace terrazzo {

namespace {

constexpr int orientations = 6, scales = 3;
constexpr double deviations[scales] = {1, 2, 4}, elongation = 3, blob_deviation = 10;

/// A square filter, `reach` pixels to either side of its centre.
struct Filter {
  int reach;
  std::vector<double> values;

  Filter(int reach_, const std::function<double(double, double)>& value) : reach(reach_) {
    for (int y = -reach; y <= reach; y++)
      for (int x = -reach; x <= reach; x++) values.push_back(value(x, y));
    double mean = 0, size = 0;
    for (const double v : values) mean += v;
    mean /= double(values.size());
    for (double& v : values) v -= mean;
    for (const double v : values) size += std::fabs(v);
    for (double& v : values) v /= size;
  }
};

/// The derivative of given order across, a Gaussian along; constant factors do not matter.
Filter oriented_filter(int reach, double deviation, int orientation, int order) {
  const double turns = orientation / (2.0 * orientations);
  const double c = portable::cos_turns(turns), s = portable::sin_turns(turns), variance = deviation * deviation;
  return Filter(reach, [=](double x, double y) {
    const double along = x * c + y * s, across = y * c - x * s;
    const double derivative = order == 1 ? across : variance - across * across;
    return derivative * gaussian(across, deviation) * gaussian(along, elongation * deviation);
  });
}

using Grid = std::vector<std::complex<double>>;

/// The spectra of the filters, two by two: one as the real part, one as the imaginary part. Their responses to real
/// images come out the same way.
class Spectra {
 public:
  Spectra(double scale, Size image) : reach_(int(portable::floor_int(24 * scale + 0.5))) {
    const int longest = std::max(image.width, image.height);
    side_ = std::min(padded_length(std::max(256, 4 * reach_)), padded_length(longest + 2 * reach_));
    for (const double d : deviations)
      for (int o = 0; o < orientations; o++)
        pairs_.push_back(spectrum(oriented_filter(reach_, d * scale, o, 1), oriented_filter(reach_, d * scale, o, 2)));
    const double blob = blob_deviation * scale;
    const Filter plain(reach_, [=](double x, double y) { return gaussian(x, blob) * gaussian(y, blob); });
    const Filter laplacian(reach_, [=](double x, double y) {
      return (2 * blob * blob - x * x - y * y) * gaussian(x, blob) * gaussian(y, blob);
    });
    pairs_.push_back(spectrum(plain, laplacian));
  }

  int reach() const { return reach_; }
  int side() const { return side_; }
  /// Scale by scale the edges and bars of each orientation, then the blobs.
  const std::vector<Grid>& pairs() const { return pairs_; }

 private:
  Grid spectrum(const Filter& real, const Filter& imaginary) const {
    Grid grid(size_t(side_) * side_);
    size_t i = 0;
    // Divided here by what the inverse transform multiplies by.
    const double unit = 1.0 / (double(side_) * side_);
    for (int y = -reach_; y <= reach_; y++)
      for (int x = -reach_; x <= reach_; x++, i++)
        grid[size_t(wrap(y, side_)) * side_ + wrap(x, side_)] = {real.values[i] * unit, imaginary.values[i] * unit};
    transform_2d(grid, side_, side_, false);
    return grid;
  }

  int reach_, side_;
  std::vector<Grid> pairs_;
};

Grid block_spectrum(const Planes& image, const Spectra& spectra, int left, int top) {
  const int side = spectra.side();
  Grid grid(size_t(side) * side);
  for (int y = 0; y < side; y++) {
    const int row = image.row(top + y - spectra.reach());
    for (int x = 0; x < side; x++)
      grid[size_t(y) * side + x] = double(*image.at(image.column(left + x - spectra.reach()), row));
  }
  transform_2d(grid, side, side, false);
  return grid;
}

/// The responses of the pixels of `block`, whose spectrum this is.
void respond(const Grid& spectrum, const Spectra& spectra, const Rect& block, int width, FilterResponses& out) {
  const int side = spectra.side();
  Grid grid(spectrum.size());
  for (size_t pair = 0; pair < spectra.pairs().size(); pair++) {
    const Grid& filter = spectra.pairs()[pair];
    for (size_t i = 0; i < grid.size(); i++) {
      const double a = spectrum[i].real(), b = spectrum[i].imag(), c = filter[i].real(), d = filter[i].imag();
      grid[i] = {a * c - b * d, a * d + b * c};
    }
    transform_2d(grid, side, side, true);
    const size_t scale = pair / orientations;
    for (int y = 0; y < block.height; y++)
      for (int x = 0; x < block.width; x++) {
        const std::complex<double> r = grid[size_t(y + spectra.reach()) * side + x + spectra.reach()];
        const size_t pixel = size_t(block.y + y) * width + block.x + x;
        if (scale == scales) {
          out.blobs[2 * pixel] = float(r.real());
          out.blobs[2 * pixel + 1] = float(r.imag());
          continue;
        }
        float &edge = out.edges[scales * pixel + scale], &bar = out.bars[scales * pixel + scale];
        edge = std::max(edge, float(std::fabs(r.real())));
        if (std::fabs(float(r.imag())) > std::fabs(bar)) bar = float(r.imag());
      }
  }
}

}  // namespace

FilterResponses mr8_responses(const Planes& image, double scale, const Task& task) {
  const Spectra spectra(scale, image.size);
  task.check();
  const size_t pixels = size_t(image.size.area());
  FilterResponses out{std::vector<float>(scales * pixels), std::vector<float>(scales * pixels),
                      std::vector<float>(2 * pixels)};
  const int useful = spectra.side() - 2 * spectra.reach();
  const int across = (image.size.width + useful - 1) / useful, down = (image.size.height + useful - 1) / useful;
  std::atomic<int> done{0};
  tbb::parallel_for(0, across * down, [&](int i) {
    task.progress(double(done++) / (across * down));
    const Rect block = intersect({i % across * useful, i / across * useful, useful, useful}, whole(image.size));
    respond(block_spectrum(image, spectra, block.x, block.y), spectra, block, image.size.width, out);
  });
  return out;
}

}  // namespace terrazzo
