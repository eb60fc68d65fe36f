#include "core/image/normal_convention.h"

#include <algorithm>
#include <cmath>

namespace terrazzo {

namespace {

/// Channels of an image averaged over the cells of a regular grid, one plane per channel.
struct Grid {
  Size size;
  std::vector<std::vector<double>> planes;
  double at(int plane, int x, int y) const { return planes[plane][size_t(y) * size.width + x]; }
};

Grid averaged(const Image& image, Size size) {
  Grid g{size, std::vector<std::vector<double>>(image.channels(), std::vector<double>(size.area()))};
  std::vector<float> band;
  for (int y = 0; y < size.height; y++) {
    const int y0 = int(int64_t{y} * image.height() / size.height);
    const int y1 = int(int64_t{y + 1} * image.height() / size.height);
    const Rect r{0, y0, image.width(), y1 - y0};
    band.resize(size_t(r.area()) * image.channels());
    image.read(r, band.data());
    for (int x = 0; x < size.width; x++) {
      const int x0 = int(int64_t{x} * image.width() / size.width);
      const int x1 = int(int64_t{x + 1} * image.width() / size.width);
      for (int c = 0; c < image.channels(); c++) {
        double sum = 0;
        for (int j = 0; j < r.height; j++)
          for (int i = x0; i < x1; i++) sum += band[(size_t(j) * r.width + i) * image.channels() + c];
        g.planes[c][size_t(y) * size.width + x] = sum / (double(r.height) * (x1 - x0));
      }
    }
  }
  return g;
}

/// Pearson's correlation, summed in the order of the calls to add.
class Correlation {
 public:
  void add(double a, double b) {
    n_ += 1;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  double value() const {
    const double va = aa_ * n_ - a_ * a_, vb = bb_ * n_ - b_ * b_;
    return va > 1e-12 * n_ * n_ && vb > 1e-12 * n_ * n_ ? (ab_ * n_ - a_ * b_) / std::sqrt(va * vb) : 0;
  }

 private:
  double n_ = 0, a_ = 0, b_ = 0, aa_ = 0, bb_ = 0, ab_ = 0;
};

constexpr int largest_grid = 512;

}  // namespace

ConventionEvidence convention_from_height(const Image& normal, const Image& height) {
  ConventionEvidence out;
  const Size size{std::min({normal.width(), height.width(), largest_grid}),
                  std::min({normal.height(), height.height(), largest_grid})};
  if (size.width < 3 || size.height < 3 || normal.channels() < 2) return out;
  const Grid n = averaged(normal, size), h = averaged(height, size);
  Correlation along_x, along_y;
  for (int y = 1; y + 1 < size.height; y++)
    for (int x = 1; x + 1 < size.width; x++) {
      along_x.add(n.at(0, x, y), h.at(0, x - 1, y) - h.at(0, x + 1, y));
      along_y.add(n.at(1, x, y), h.at(0, x, y + 1) - h.at(0, x, y - 1));
    }
  out.along_x = along_x.value();
  out.along_y = along_y.value();
  // Grooves that run across (planks, say) leave red without evidence: then a strong green must do.
  constexpr double clear = 0.1, strong = 0.5;
  if (std::abs(out.along_y) < (std::abs(out.along_x) < clear ? strong : clear)) return out;
  if (std::abs(out.along_x) < clear) {
    out.normal_y = out.along_y > 0 ? NormalY::up : NormalY::down;
    return out;
  }
  out.height_inverted = out.along_x < 0;
  out.normal_y = (out.along_x > 0) == (out.along_y > 0) ? NormalY::up : NormalY::down;
  return out;
}

ConventionEvidence convention_from_curl(const Image& normal) {
  ConventionEvidence out;
  const Size size{std::min(normal.width(), largest_grid), std::min(normal.height(), largest_grid)};
  if (size.width < 3 || size.height < 3 || normal.channels() < 2) return out;
  const Grid n = averaged(normal, size);
  Correlation curl;
  for (int y = 1; y + 1 < size.height; y++)
    for (int x = 1; x + 1 < size.width; x++)
      curl.add(n.at(0, x, y - 1) - n.at(0, x, y + 1), n.at(1, x + 1, y) - n.at(1, x - 1, y));
  out.along_y = curl.value();
  constexpr double clear = 0.2;
  if (std::abs(out.along_y) >= clear) out.normal_y = out.along_y > 0 ? NormalY::up : NormalY::down;
  return out;
}

}  // namespace terrazzo
