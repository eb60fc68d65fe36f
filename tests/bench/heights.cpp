// What resolving did to heights at seams and elsewhere; tests/bench/heights.sh builds and starts this.
// Arguments: the exemplar's height map, the uv map as 16-bit PNG, and height maps that were resolved through it.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/exemplar/uv_image.h"
#include "core/image_io/image_file.h"

using namespace terrazzo;

namespace {

std::vector<float> heights(const std::string& path, Size* size) {
  const ImagePtr image = read_image(path, {.size = {}, .semantic = Semantic::height, .color_space = "raw"}, {});
  if (image->channels() != 1) throw Error(path + ": expected one channel");
  *size = image->size();
  return image->pixels();
}

/// One over the other, or 0.
double ratio(double a, double b) {
  return b > 0 ? a / b : 0;
}

class Comparison {
 public:
  Comparison(std::vector<float> exemplar, UvMapPtr uv) : exemplar_(std::move(exemplar)), uv_(std::move(uv)) {
    sorted_ = exemplar_;
    std::sort(sorted_.begin(), sorted_.end());
    range_ = double(sorted_.back()) - sorted_.front();
  }

  void print(const std::string& name, const std::vector<float>& result) const {
    Sums s;
    const Size size = uv_->size();
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) {
        if (x + 1 < size.width) add(result, x, y, 1, 0, s);
        if (y + 1 < size.height) add(result, x, y, 0, 1, s);
      }
    std::vector<float> ordered = result;
    std::sort(ordered.begin(), ordered.end());
    double moved = 0;
    for (size_t i = 0; i < ordered.size(); i++)
      moved += std::abs(double(ordered[i]) - sorted_[i * sorted_.size() / ordered.size()]);
    const auto end = [&](float v) { return double(std::count(ordered.begin(), ordered.end(), v)); };
    std::sort(s.false_steps.begin(), s.false_steps.end());
    const auto of_slope = [&](double sum, size_t count) {
      return ratio(ratio(sum, double(count)), ratio(s.slopes, double(s.inside)));
    };
    double total = 0;
    for (const float v : s.false_steps) total += double(v);
    const size_t seams = s.false_steps.size();
    fmt::print("| {} | {:.2f} | {:.2f} | {:.1f} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {:.2f} |\n", name,
               of_slope(s.steps, seams), of_slope(total, seams),
               seams ? of_slope(double(s.false_steps[seams * 99 / 100]), 1) : 0.0, of_slope(s.rises, s.places),
               of_slope(s.changes, s.inside), 100 * moved / double(ordered.size()) / range_,
               ratio(deviation(ordered), deviation(sorted_)),
               100 * (end(sorted_.front()) + end(sorted_.back())) / double(ordered.size()));
  }

 private:
  struct Sums {
    double slopes = 0, changes = 0, steps = 0, rises = 0;
    size_t inside = 0, places = 0;
    std::vector<float> false_steps;
  };

  static double deviation(const std::vector<float>& values) {
    double sum = 0, squares = 0;
    for (const float v : values) sum += double(v);
    sum /= double(values.size());
    for (const float v : values) squares += (double(v) - sum) * (double(v) - sum);
    return std::sqrt(squares / double(values.size()));
  }

  bool lies(int x, int y) const { return x >= 0 && y >= 0 && x < uv_->exemplar().width && y < uv_->exemplar().height; }
  double at(int x, int y) const { return double(exemplar_[size_t(y) * size_t(uv_->exemplar().width) + size_t(x)]); }

  void add(const std::vector<float>& result, int x, int y, int dx, int dy, Sums& s) const {
    const size_t width = size_t(uv_->size().width), here = size_t(y) * width + size_t(x);
    const double is = double(result[here + size_t(dx) + size_t(dy) * width]) - double(result[here]);
    const ExemplarPixel p = uv_->at(x, y), q = uv_->at(x + dx, y + dy);
    const double was = at(q.x, q.y) - at(p.x, p.y);
    if (q.x == p.x + dx && q.y == p.y + dy) {
      s.slopes += std::abs(was);
      s.changes += std::abs(is - was);
      s.inside++;
      return;
    }
    // What both pieces would have gone on with.
    if (!lies(p.x + dx, p.y + dy) || !lies(q.x - dx, q.y - dy)) return;
    const double first = at(p.x + dx, p.y + dy) - at(p.x, p.y), second = at(q.x, q.y) - at(q.x - dx, q.y - dy);
    s.steps += std::abs(is);
    s.false_steps.push_back(float(beyond(is, first, second)));
    add_rise(result, x, y, dx, dy, s);
  }

  /// How far a difference is outside of what lies between two others.
  static double beyond(double is, double a, double b) {
    return std::abs(std::clamp(is, std::min(a, b), std::max(a, b)) - is);
  }

  /// The same from some pixels before the seam to as many behind it, where both pieces are large enough.
  void add_rise(const std::vector<float>& result, int x, int y, int dx, int dy, Sums& s) const {
    const int back = 8, all = 2 * back + 1;
    const int left = x - back * dx, top = y - back * dy, right = left + all * dx, bottom = top + all * dy;
    const Size size = uv_->size();
    if (left < 0 || top < 0 || right >= size.width || bottom >= size.height) return;
    const ExemplarPixel p = uv_->at(left, top), q = uv_->at(right, bottom), a = uv_->at(x, y),
                        b = uv_->at(x + dx, y + dy);
    if (a.x != p.x + back * dx || a.y != p.y + back * dy || q.x != b.x + back * dx || q.y != b.y + back * dy) return;
    if (!lies(p.x + all * dx, p.y + all * dy) || !lies(q.x - all * dx, q.y - all * dy)) return;
    const double is = double(result[size_t(bottom) * size_t(size.width) + size_t(right)]) -
                      double(result[size_t(top) * size_t(size.width) + size_t(left)]);
    s.rises += beyond(is, at(p.x + all * dx, p.y + all * dy) - at(p.x, p.y),
                      at(q.x, q.y) - at(q.x - all * dx, q.y - all * dy));
    s.places++;
  }

  std::vector<float> exemplar_, sorted_;
  UvMapPtr uv_;
  double range_ = 1;
};

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count < 4) throw Error("expected a height map, a uv map and results");
    Size exemplar, size;
    std::vector<float> from = heights(arguments[1], &exemplar);
    const ImagePtr uv = read_image(arguments[2], {}, {});
    const Comparison comparison(std::move(from), uv_from_image(*uv, exemplar));
    for (int i = 3; i < count; i++) {
      const std::vector<float> result = heights(arguments[i], &size);
      if (!(size == uv->size())) throw Error(std::string(arguments[i]) + ": expected the uv map's size");
      comparison.print(std::filesystem::path(arguments[i]).parent_path().filename().string(), result);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
