#include "core/resolve/fine_layout.h"

#include <cmath>

namespace terrazzo {

namespace {

int64_t floor_divided(int64_t a, int64_t b) {
  return a / b - (a % b != 0 && a < 0);
}

}  // namespace

int FineLayout::Scale::offset(int coarse) const {
  return int(floor_divided(2 * coarse * to + from, 2 * from));
}

FineLayout::FineLayout(UvMapPtr uv, Size exemplar, double radius)
    : uv_(std::move(uv)),
      exemplar_(exemplar),
      radius_(radius),
      x_{exemplar.width, uv_->exemplar().width},
      y_{exemplar.height, uv_->exemplar().height} {
  const double overhang = std::max(x_.overhang(), y_.overhang());
  reach_ = radius > 0 ? std::max(0, int(std::ceil(radius + overhang)) - 1) : 0;
}

void FineLayout::offsets(int left, int y, int count, Offset* out) const {
  const Size size = uv_->size(), analysed = uv_->exemplar();
  const UvWraps wraps = uv_->wraps();
  const auto place = [](int v, int n, bool around) { return around ? wrap(v, n) : std::clamp(v, 0, n - 1); };
  const int row = place(y, size.height, wraps.y);
  const ExemplarPixel* pixels = &uv_->pixels()[size_t(row) * size.width];
  for (int i = 0; i < count; i++) {
    const int column = place(left + i, size.width, wraps.x);
    // Where the output does not wrap, a place beyond its border stands for the border pixel.
    int x = pixels[column].x - (wraps.x ? left + i : column), y_offset = pixels[column].y - (wraps.y ? y : row);
    if (wraps.exemplar) {
      x = wrap(x, analysed.width);
      y_offset = wrap(y_offset, analysed.height);
    }
    out[i] = {x_.offset(x), y_.offset(y_offset)};
  }
}

void FineLayout::shown(int x, int y, int count, Offset* out) const {
  if (exemplar_ == uv_->exemplar()) {
    const ExemplarPixel* pixels = &uv_->pixels()[size_t(y) * uv_->size().width + x];
    for (int i = 0; i < count; i++) out[i] = {pixels[i].x, pixels[i].y};
    return;
  }
  const int left = owner_x(x);
  std::vector<Offset> owners(size_t(owner_x(x + count - 1) + 1 - left));
  offsets(left, owner_y(y), int(owners.size()), owners.data());
  for (int i = 0; i < count; i++) {
    const Offset& offset = owners[size_t(owner_x(x + i) - left)];
    out[i] = {x + i + offset.x, y + offset.y};
    settle(out[i].x, out[i].y);
  }
}

bool FineLayout::inside(int& x, int& y) const {
  if (!uv_->wraps().exemplar) return x >= 0 && y >= 0 && x < exemplar_.width && y < exemplar_.height;
  x = wrap(x, exemplar_.width);
  y = wrap(y, exemplar_.height);
  return true;
}

void FineLayout::settle(int& x, int& y) const {
  if (inside(x, y)) return;
  x = std::clamp(x, 0, exemplar_.width - 1);
  y = std::clamp(y, 0, exemplar_.height - 1);
}

LayoutWindow::LayoutWindow(const FineLayout& layout, const Rect& region) {
  const int left = layout.owner_x(region.x), top = layout.owner_y(region.y);
  owners_ = {left, top, layout.owner_x(region.right() - 1) + 1 - left, layout.owner_y(region.bottom() - 1) + 1 - top};
  around_ = grown(owners_, layout.reach());
  offsets_.resize(size_t(around_.area()));
  for (int y = 0; y < around_.height; y++)
    layout.offsets(around_.x, around_.y + y, around_.width, &offsets_[size_t(y) * around_.width]);
  if (layout.reach() > 0) find_calm(layout.reach());
}

void LayoutWindow::find_calm(int reach) {
  const int side = 2 * reach + 1;
  calm_.assign(size_t(owners_.area()), 0);
  std::vector<int> rows(
      size_t(owners_.width));  // how many rows up to here agree across the window and with one another
  for (int y = 0; y < around_.height; y++) {
    const Offset* row = &offsets_[size_t(y) * around_.width];
    int equal = 0;  // how many offsets up to here are the same
    for (int x = 0; x < around_.width; x++) {
      equal = x > 0 && row[x] == row[x - 1] ? equal + 1 : 1;
      const int column = x - 2 * reach;
      if (column < 0) continue;
      const bool goes_on = rows[column] > 0 && row[x] == row[x - around_.width];
      rows[column] = equal < side ? 0 : goes_on ? rows[column] + 1 : 1;
      if (rows[column] >= side) calm_[size_t(y - 2 * reach) * owners_.width + column] = 1;
    }
  }
}

}  // namespace terrazzo
