#include "core/picture/picture_grid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/filter/resample.h"
#include "core/image_io/color.h"
#include "core/picture/pixel_font.h"
#include "core/picture/sheet_canvas.h"

namespace terrazzo {

namespace {

constexpr float ink = 0.85f;
constexpr int64_t longest_side = 32768;
/// Rows computed at once, so that a huge picture never exists as a whole.
constexpr int rows_at_once = 16;
constexpr int most_caption_lines = 3;

int columns_of(size_t pictures, const GridSpec& spec) {
  return int(std::min(pictures, size_t(spec.columns)));
}

/// Pixels per dot of the font: about thirty characters fit below a large picture, and letters of seven pixels below
/// small ones would be too small to read.
int dot_size(const GridSpec& spec) {
  return std::max(2, spec.cell.width / (30 * glyph_advance));
}

int line_height(const GridSpec& spec) {
  return (glyph_height + 2) * dot_size(spec);
}

std::vector<std::string> caption_lines(const std::string& caption, const GridSpec& spec) {
  return wrapped(caption, spec.cell.width / (glyph_advance * dot_size(spec)), most_caption_lines);
}

/// A cell with room for the longest caption.
Size place_size(const GridSpec& spec) {
  size_t lines = 0;
  for (const std::string& caption : spec.captions) lines = std::max(lines, caption_lines(caption, spec).size());
  return {spec.cell.width, spec.cell.height + int(lines) * line_height(spec)};
}

Size fitted(Size size, const GridSpec& spec) {
  double scale = std::min(double(spec.cell.width) / size.width, double(spec.cell.height) / size.height);
  if (!spec.enlarge) scale = std::min(scale, 1.0);
  const auto scaled = [scale](int length, int room) { return std::clamp(int(std::lround(length * scale)), 1, room); };
  return {scaled(size.width, spec.cell.width), scaled(size.height, spec.cell.height)};
}

/// The picture for display: scaled, colours in sRGB.
ImagePtr displayed(const ImagePtr& image, Size size) {
  Hasher recipe;
  recipe.add("picture of a grid").add(image->digest()).add(size.width).add(size.height);
  const ImagePtr scaled = resampled(image, size, "auto", Outside::clamp, recipe.digest());
  return scaled->info().color_space == "raw" ? scaled : convert_color(scaled, "srgb_texture");
}

void draw_picture(const Image& picture, int left, int top, const Task& task, SheetCanvas& sheet) {
  const bool colored = picture.channels() >= SheetCanvas::channels;
  for (int y = 0; y < picture.height(); y += rows_at_once) {
    task.check();
    const Rect rows{0, y, picture.width(), std::min(rows_at_once, picture.height() - y)};
    const std::vector<float> pixels = picture.read(rows);
    std::vector<float> colors(size_t(rows.area()) * SheetCanvas::channels);
    for (size_t i = 0; i < colors.size(); i++) {
      const size_t pixel = i / SheetCanvas::channels, channel = i % SheetCanvas::channels;
      const float v = pixels[pixel * picture.channels() + (colored ? channel : 0)];
      colors[i] = v > 0 ? std::min(v, 1.f) : 0.f;
    }
    for (int row = 0; row < rows.height; row++)
      sheet.put(left, top + y + row, &colors[size_t(row) * rows.width * SheetCanvas::channels], rows.width);
  }
}

void draw_caption(const std::string& caption, int left, int top, const GridSpec& spec, SheetCanvas& sheet) {
  const int dot = dot_size(spec);
  for (const std::string& line : caption_lines(caption, spec)) {
    const int indent = (spec.cell.width - character_count(line) * glyph_advance * dot) / 2;
    for_each_dot(line, [&](int x, int y) { sheet.fill({left + indent + x * dot, top + y * dot, dot, dot}, ink); });
    top += line_height(spec);
  }
}

}  // namespace

Size grid_size(size_t pictures, const GridSpec& spec) {
  const int columns = columns_of(pictures, spec);
  const int64_t rows = (int64_t(pictures) + columns - 1) / columns;
  const Size place = place_size(spec);
  const int64_t width = spec.gap + columns * int64_t{place.width + spec.gap};
  const int64_t height = spec.gap + rows * int64_t{place.height + spec.gap};
  if (std::max(width, height) > longest_side)
    throw Error(
        fmt::format("{} pictures in {} columns make a sheet of {}x{} pixels; expected at most {} a side: make "
                    "the cells smaller",
                    pictures, columns, width, height, longest_side));
  return {int(width), int(height)};
}

void require_grid(size_t pictures, const GridSpec& spec) {
  if (pictures == 0) throw Error("a contact sheet needs at least one picture");
  check_all(
      [&] {
        if (spec.captions.size() > pictures)
          throw Error("captions", fmt::format("expected at most {}, one for each picture; found {}",
                                              counted(int64_t(pictures), "caption"), spec.captions.size()));
      },
      [&] { grid_size(pictures, spec); });
}

ImagePtr picture_grid(const std::vector<ImagePtr>& pictures, const GridSpec& spec, const Task& task) {
  require_grid(pictures.size(), spec);
  SheetCanvas sheet(grid_size(pictures.size(), spec));
  const Size place = place_size(spec);
  tbb::parallel_for(size_t{0}, pictures.size(), [&](size_t i) {
    const CurrentTask scope(task);
    const int column = int(i) % columns_of(pictures.size(), spec), row = int(i) / columns_of(pictures.size(), spec);
    const int left = spec.gap + column * (place.width + spec.gap), top = spec.gap + row * (place.height + spec.gap);
    const ImagePtr picture = displayed(pictures[i], fitted(pictures[i]->size(), spec));
    draw_picture(*picture, left + (spec.cell.width - picture->width()) / 2,
                 top + (spec.cell.height - picture->height()) / 2, task, sheet);
    if (i < spec.captions.size())
      draw_caption(spec.captions[i], left, top + spec.cell.height + 2 * dot_size(spec), spec, sheet);
  });
  return std::move(sheet).finished();
}

}  // namespace terrazzo
