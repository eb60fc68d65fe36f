#include "core/procedural/labels.h"

#include <array>
#include <unordered_map>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/base/disjoint_sets.h"

namespace terrazzo {

namespace {

/// The neighbours of pixels, across the border if the canvas wraps.
struct Neighbourhood {
  int width, height;
  bool wraps;

  /// Left, above, right and below; a pixel at a border that does not wrap is its own neighbour.
  std::array<uint32_t, 4> around(uint32_t pixel) const {
    const int x = int(pixel) % width, y = int(pixel) / width;
    return {at(x - 1, y, pixel), at(x, y - 1, pixel), at(x + 1, y, pixel), at(x, y + 1, pixel)};
  }

 private:
  uint32_t at(int x, int y, uint32_t outside) const {
    if (!wraps && (x < 0 || y < 0 || x == width || y == height)) return outside;
    return uint32_t((y + height) % height * width + (x + width) % width);
  }
};

std::vector<uint64_t> sampled_elements(const Surface& surface, Size size, const Task& task) {
  std::vector<uint64_t> elements(size_t(size.area()));
  const double step = 1.0 / size.width;
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++)
      elements[size_t(y) * size_t(size.width) + size_t(x)] = surface.element((x + 0.5) * step, (y + 0.5) * step);
  });
  return elements;
}

/// For every pixel whether it belongs to the largest region of its element.
std::vector<bool> in_largest_region(const std::vector<uint64_t>& elements, const Neighbourhood& pixels) {
  const uint32_t count = uint32_t(elements.size());
  DisjointSets regions(count);
  for (uint32_t i = 0; i < count; i++)
    for (const uint32_t n : pixels.around(i))
      if (elements[i] == elements[n]) regions.join(i, n);
  std::vector<uint32_t> areas(count);
  for (uint32_t i = 0; i < count; i++) areas[regions.find(i)]++;
  std::unordered_map<uint64_t, uint32_t> largest;
  for (uint32_t i = 0; i < count; i++) {
    const auto [at, is_new] = largest.try_emplace(elements[i], i);
    if (!is_new && areas[i] > areas[at->second]) at->second = i;
  }
  std::vector<bool> out(count);
  for (uint32_t i = 0; i < count; i++) out[i] = regions.find(i) == largest.at(elements[i]);
  return out;
}

/// Assigns the other regions to the elements around them, from their outlines inwards.
void join_fragments(std::vector<uint64_t>& elements, const Neighbourhood& pixels) {
  std::vector<bool> settled = in_largest_region(elements, pixels);
  std::vector<uint32_t> open;
  for (uint32_t i = 0; i < elements.size(); i++)
    if (!settled[i]) open.push_back(i);
  while (!open.empty()) {
    std::vector<uint32_t> left;
    for (const uint32_t i : open) {
      for (const uint32_t n : pixels.around(i)) {
        if (!settled[n]) continue;
        elements[i] = elements[n];
        settled[i] = true;
        break;
      }
      if (!settled[i]) left.push_back(i);
    }
    open = std::move(left);
  }
}

}  // namespace

ImagePtr element_labels(const Surface& surface, Size size, bool wraps, const Task& task) {
  std::vector<uint64_t> elements = sampled_elements(surface, size, task);
  join_fragments(elements, {size.width, size.height, wraps});
  std::unordered_map<uint64_t, size_t> numbers;
  for (uint64_t& element : elements) element = numbers.try_emplace(element, numbers.size()).first->second;
  const double steps = double(std::max<size_t>(1, numbers.size() - 1));
  std::vector<float> labels(elements.size());
  for (size_t i = 0; i < labels.size(); i++) labels[i] = float(double(elements[i]) / steps);
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  return Image::from_floats(info, std::move(labels));
}

}  // namespace terrazzo
