#include "runner/python/image_pixels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <tbb/task_arena.h>

#include "core/base/suggest.h"
#include "core/image/image_limits.h"
#include "core/image_io/color.h"
#include "runner/python/current_node.h"
#include "runner/python/waiting.h"

namespace terrazzo::python {

namespace py = pybind11;

namespace {

/// The image with its pixels in memory. Releases the GIL while they are computed.
ImagePtr in_memory(ImageHandle& handle) {
  if (handle.image->in_memory()) return handle.image;
  if (ImagePtr pulled = handle.pulled.lock()) return pulled;
  const ImagePtr lazy = handle.image;
  ImagePtr out;
  if (const NodeContext* node = current_node()) {
    const Unlocked free;
    // Isolated: a thread that waits for the strips must not start another node, which may need the GIL.
    tbb::this_task_arena::isolate([&] { out = materialized(lazy, node->task()); });
  } else {
    std::atomic<bool> cancelled = false;
    do_and_wait([&] { out = materialized(lazy, Task(&cancelled, {})); }, cancelled);
  }
  handle.pulled = out;
  return out;
}

py::array pixels_of(ImageHandle& handle) {
  const ImagePtr image = in_memory(handle);
  std::vector<py::ssize_t> shape = {image->height(), image->width()};
  if (image->channels() > 1) shape.push_back(image->channels());
  return read_only(py::array_t<float>(shape, image->in_memory(), owner_of(image)));
}

py::object as_array(ImageHandle& handle, const py::object& dtype, const py::object& copy) {
  py::object out = pixels_of(handle);
  const bool must_copy = !copy.is_none() && py::cast<bool>(copy);
  if (!dtype.is_none()) return out.attr("astype")(dtype, py::arg("copy") = must_copy);
  return must_copy ? out.attr("copy")() : out;
}

Semantic semantic_of(const std::string& name) {
  if (const std::optional<Semantic> found = semantic_from(name)) return *found;
  const std::vector<std::string> all(semantic_names.begin(), semantic_names.end());
  throw py::value_error(fmt::format("there is no semantic \"{}\"{}", name, suggestion(name, all)));
}

NormalY normal_y_of(const std::string& name) {
  if (name == "up") return NormalY::up;
  if (name == "down") return NormalY::down;
  throw py::value_error(fmt::format("normal_y is \"up\" or \"down\", not \"{}\"", name));
}

/// The divisor of integers; 1 for other types.
float scale_of(const py::array& array, Depth& depth) {
  const char kind = array.dtype().kind();
  if (kind == 'u' && array.itemsize() <= 2) {
    depth = array.itemsize() == 1 ? Depth::u8 : Depth::u16;
    return array.itemsize() == 1 ? 255.0f : 65535.0f;
  }
  if (kind == 'f' || kind == 'b') return 1;
  throw py::type_error(fmt::format("expected an array of floats, uint8, uint16 or bool, found {}",
                                   py::cast<std::string>(py::str(array.dtype()))));
}

ImageHandlePtr from_array(const py::array& array, const std::string& semantic,
                          const std::optional<std::string>& color_space, const std::string& normal_y) {
  ImageInfo info;
  const float scale = scale_of(array, info.depth);
  const bool has_channels = array.ndim() == 3;
  if ((array.ndim() != 2 && !has_channels) || array.size() == 0 ||
      (has_channels && (array.shape(2) < 1 || array.shape(2) > 4)))
    throw py::value_error(
        "expected an array of shape (height, width) or (height, width, channels), with 1 to 4 channels");
  if (array.shape(0) > 65536 || array.shape(1) > 65536)
    throw py::value_error("an image has at most 65536 pixels a side");
  info.size = {int(array.shape(1)), int(array.shape(0))};
  info.channels = has_channels ? int(array.shape(2)) : 1;
  const uint64_t bytes = uint64_t(array.size()) * sizeof(float);
  if (bytes > memory_budget())  // an array may be a view that takes no memory itself
    throw py::value_error(
        fmt::format("an image of {} pixels and {} channels takes {} MiB, more than the memory budget of {} MiB; see "
                    "set_memory_budget",
                    describe(info.size), info.channels, bytes >> 20, memory_budget() >> 20));
  info.semantic = semantic_of(semantic);
  info.normal_y = normal_y_of(normal_y);
  const auto floats = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!floats) throw py::error_already_set();
  std::vector<float> pixels(floats.data(), floats.data() + floats.size());
  if (scale != 1) std::ranges::for_each(pixels, [scale](float& v) { v /= scale; });
  if (!std::ranges::all_of(pixels, [](float v) { return std::isfinite(v); }))
    throw py::value_error("the array has values that are infinite or no numbers");
  const Unlocked free;
  info.color_space = color_space ? canonical_color_space(*color_space) : assumed_color_space(info.semantic, info.depth);
  return std::make_shared<ImageHandle>(ImageHandle{Image::from_floats(info, std::move(pixels))});
}

}  // namespace

void bind_images(py::module_& module) {
  py::class_<ImageHandle, ImageHandlePtr> type(
      module, "Image", "One map: pixels, and what they mean. Immutable. Pixels may be computed when you read them.");
  type.def_static(
          "from_numpy", &from_array, py::arg("array"), py::arg("semantic") = "data", py::kw_only(),
          py::arg("color_space") = py::none(), py::arg("normal_y") = "up",
          "An image of an array's pixels: (height, width) or (height, width, channels). Floats are taken as they\n"
          "are; uint8 and uint16 become 0..1, and are written with 8 and 16 bits again.")
      .def(
          "numpy", &pixels_of,
          "A read-only view of the pixels as float32: (height, width) or (height, width, channels). Keeps them alive;\n"
          "no copy if they are in memory.")
      .def("__array__", &as_array, py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def_property_readonly("width", [](const ImageHandle& i) { return i.image->width(); })
      .def_property_readonly("height", [](const ImageHandle& i) { return i.image->height(); })
      .def_property_readonly("channels", [](const ImageHandle& i) { return i.image->channels(); })
      .def_property_readonly(
          "semantic", [](const ImageHandle& i) { return name_of(i.image->info().semantic); },
          "what it means: base_color, normal, height, ...")
      .def_property_readonly("color_space", [](const ImageHandle& i) { return i.image->info().color_space; })
      .def_property_readonly(
          "depth", [](const ImageHandle& i) { return name_of(i.image->info().depth); },
          "of its file, or that it is written with")
      .def_property_readonly(
          "normal_y", [](const ImageHandle& i) { return i.image->info().normal_y == NormalY::up ? "up" : "down"; })
      .def_property_readonly("digest", [](const ImageHandle& i) { return i.image->digest().hex(); })
      .def("__repr__", [](const ImageHandle& i) {
        return fmt::format("<Image {}: {}, {} channels>", name_of(i.image->info().semantic), describe(i.image->size()),
                           i.image->channels());
      });
  type.attr("__module__") = "terrazzo";
}

}  // namespace terrazzo::python
