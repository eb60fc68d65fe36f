#include "core/picture/contact_sheet.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/float_planes.h"
#include "core/picture/pixel_font.h"
#include "core/picture/sheet_canvas.h"

namespace terrazzo {

namespace {

constexpr int border = 6;
constexpr int channels = SheetCanvas::channels;

/// The picture as RGB, reduced by a whole factor as its rows are computed.
Planes reduced(const Image& image, int factor) {
  const Size size{std::max(1, image.width() / factor), std::max(1, image.height() / factor)};
  Planes sums = Planes::zeros(size, channels);
  std::vector<int> count(size_t(size.area()));
  for_each_strip(image, [&](const Rect& strip, const float* pixels) {
    for (int y = strip.y; y < strip.bottom(); y++)
      for (int x = 0; x < strip.width; x++, pixels += image.channels()) {
        const int to_x = std::min(x / factor, size.width - 1), to_y = std::min(y / factor, size.height - 1);
        for (int k = 0; k < channels; k++)
          sums.at(to_x, to_y)[k] += std::clamp(pixels[image.channels() >= 3 ? k : 0], 0.f, 1.f);
        count[size_t(to_y) * size.width + to_x]++;
      }
  });
  for (size_t i = 0; i < sums.values.size(); i++) sums.values[i] /= float(count[i / channels]);
  return sums;
}

/// Where rows or columns begin, given their lengths, the gap after each and a border around; the last number is the
/// total.
std::vector<int> starts(const std::vector<int>& lengths, int after) {
  std::vector<int> out = {border};
  for (const int length : lengths) out.push_back(out.back() + length + after + border);
  return out;
}

int scaled(int length, double scale) {
  return std::max(1, int(length * scale));
}

constexpr int caption_gap = 2;
constexpr int caption_height = caption_gap + glyph_height;

void write_caption(SheetCanvas& sheet, const std::string& text, int left, int top, int width) {
  constexpr float grey = 0.85f;
  for_each_dot(shortened(text, width / glyph_advance), [&](int x, int y) {
    if (left + x < sheet.size().width && top + y < sheet.size().height) sheet.fill({left + x, top + y, 1, 1}, grey);
  });
}

}  // namespace

ImagePtr contact_sheet(const std::vector<std::vector<ImagePtr>>& rows, int max_side,
                       const std::vector<std::vector<std::string>>& captions) {
  size_t columns = 0;
  for (const auto& row : rows) columns = std::max(columns, row.size());
  std::vector<int> widths(columns), heights(rows.size());
  for (size_t y = 0; y < rows.size(); y++)
    for (size_t x = 0; x < rows[y].size(); x++)
      if (const ImagePtr& image = rows[y][x]) {
        widths[x] = std::max(widths[x], image->width());
        heights[y] = std::max(heights[y], image->height());
      }
  const int64_t width = std::accumulate(widths.begin(), widths.end(), int64_t{0});
  const int64_t height = std::accumulate(heights.begin(), heights.end(), int64_t{0});
  if (width == 0) throw Error("a contact sheet needs at least one picture");
  const int borders_x = border * int(columns + 1), below = captions.empty() ? 0 : caption_height;
  const int borders_y = border * int(rows.size() + 1) + below * int(rows.size());
  const int room_x = max_side - borders_x, room_y = max_side - borders_y;
  if (room_x < int(columns) || room_y < int(rows.size()))
    throw Error(fmt::format("a contact sheet of {} by {} pictures needs at least {} pixels a side, not {}", columns,
                            rows.size(), std::max(borders_x + int(columns), borders_y + int(rows.size())), max_side));
  const double scale = std::min({1.0, double(room_x) / double(width), double(room_y) / double(height)});
  for (int& w : widths) w = scaled(w, scale);
  for (int& h : heights) h = scaled(h, scale);
  const std::vector<int> left = starts(widths, 0), top = starts(heights, below);

  SheetCanvas sheet({std::min(left.back(), max_side), std::min(top.back(), max_side)});
  for (size_t y = 0; y < rows.size(); y++)
    for (size_t x = 0; x < rows[y].size(); x++) {
      const ImagePtr& image = rows[y][x];
      if (!image) continue;
      const Size size{scaled(image->width(), scale), scaled(image->height(), scale)};
      const Planes picture = resampled(reduced(*image, std::max(1, int(1 / scale))), size);
      for (int v = 0; v < size.height && top[y] + v < sheet.size().height; v++)
        sheet.put(left[x], top[y] + v, picture.at(0, v), std::min(size.width, sheet.size().width - left[x]));
    }
  for (size_t y = 0; y < captions.size(); y++)
    for (size_t x = 0; x < captions[y].size(); x++)
      write_caption(sheet, captions[y][x], left[x], top[y] + heights[y] + caption_gap, widths[x]);
  return std::move(sheet).finished();
}

ImagePtr comparison_sheet(const Material& exemplar, const Material& result, const std::vector<std::string>& maps,
                          int max_side) {
  std::vector<ImagePtr> above, below;
  std::vector<std::string> of_exemplar, of_result;
  for (const std::string& name : maps) {
    above.push_back(exemplar.find(std::string_view(name)));
    below.push_back(result.find(std::string_view(name)));
    of_exemplar.push_back("exemplar: " + name);
    of_result.push_back("result: " + name);
  }
  if (maps.size() == 1)
    return contact_sheet({{above.front(), below.front()}}, max_side, {{of_exemplar.front(), of_result.front()}});
  return contact_sheet({above, below}, max_side, {of_exemplar, of_result});
}

}  // namespace terrazzo
