#include "core/procedural/labels.h"

#include <unordered_map>
#include <vector>

#include <tbb/parallel_for.h>

namespace terrazzo {

ImagePtr element_labels(const Surface& surface, Size size, const Task& task) {
  const size_t width = size_t(size.width);
  std::vector<uint64_t> elements(size_t(size.area()));
  const double step = 1.0 / size.width;
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++)
      elements[size_t(y) * width + size_t(x)] = surface.element((x + 0.5) * step, (y + 0.5) * step);
  });
  std::unordered_map<uint64_t, size_t> numbers;
  for (uint64_t& element : elements) element = numbers.try_emplace(element, numbers.size()).first->second;
  const double steps = double(std::max<size_t>(1, numbers.size() - 1));
  std::vector<float> labels(elements.size());
  for (size_t i = 0; i < labels.size(); i++) labels[i] = float(double(elements[i]) / steps);
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  return Image::from_floats(info, std::move(labels));
}

}  // namespace terrazzo
