#include "runner/python/values.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "core/base/suggest.h"

namespace terrazzo::python {

namespace py = pybind11;

namespace {

std::shared_ptr<MaterialHandle> handle_of(const MaterialPtr& material) {
  auto out = std::make_shared<MaterialHandle>(MaterialHandle{material, {}});
  for (const Map& m : material->maps())
    out->maps.emplace_back(m.name, std::make_shared<ImageHandle>(ImageHandle{m.image}));
  return out;
}

ImageHandlePtr map_of(const MaterialHandle& material, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [map, image] : material.maps) {
    if (map == name) return image;
    names.push_back(map);
  }
  throw py::key_error(
      fmt::format("the material has no map \"{}\"; it has {}{}", name, listed(names), did_you_mean(name, names)));
}

std::shared_ptr<MaterialHandle> make_material(const std::string& name, const py::dict& maps,
                                              const std::pair<double, double>& metres) {
  std::vector<Map> all;
  for (const auto& [map, image] : maps)
    all.push_back({py::cast<std::string>(map), std::get<ImagePtr>(from_python(image, ValueType::image))});
  return handle_of(Material::make(name, std::move(all), {metres.first, metres.second}));
}

py::dict figures_of(const ReportHandle& handle) {
  py::dict out;
  for (const Report::Figure& f : handle.report->figures()) out[py::str(f.name)] = py::cast(f.value);
  return out;
}

py::dict pictures_of(const ReportHandle& handle) {
  py::dict out;
  for (const Report::Picture& p : handle.report->pictures()) out[py::str(p.name)] = to_python(Value(p.image));
  return out;
}

py::array uv_pixels(const UvMapHandle& handle) {
  const Size size = handle.map->size();
  const auto* pixels = reinterpret_cast<const uint16_t*>(handle.map->pixels().data());
  return read_only(py::array_t<uint16_t>({size.height, size.width, 2}, pixels, owner_of(handle.map)));
}

std::pair<int, int> pair_of(Size size) {
  return {size.width, size.height};
}

void bind_material(py::module_& module) {
  py::class_<MaterialHandle, std::shared_ptr<MaterialHandle>> type(
      module, "Material",
      "Maps by name that share one surface: base_color, normal, height, ...\n\n"
      "Material(name, {\"height\": image}) makes one; metres is (width, height) of the surface, if that is known.");
  type.def(py::init(&make_material), py::arg("name"), py::arg("maps"), py::kw_only(),
           py::arg("metres") = std::pair<double, double>{0, 0})
      .def_property_readonly("name", [](const MaterialHandle& m) { return m.material->name(); })
      .def_property_readonly(
          "size", [](const MaterialHandle& m) { return pair_of(m.material->size()); },
          "(width, height) of the largest map")
      .def_property_readonly(
          "metres",
          [](const MaterialHandle& m) -> std::optional<std::pair<double, double>> {
            const PhysicalSize s = m.material->metres();
            return s.is_known() ? std::optional(std::pair(s.width, s.height)) : std::nullopt;
          },
          "(width, height) of the surface, or None")
      .def_property_readonly("digest", [](const MaterialHandle& m) { return m.material->digest().hex(); })
      .def("__getitem__", &map_of, py::arg("name"))
      .def("__contains__",
           [](const MaterialHandle& m, const std::string& name) { return bool(m.material->find(name)); })
      .def("__len__", [](const MaterialHandle& m) { return m.maps.size(); })
      .def("__iter__",
           [](const MaterialHandle& m) {
             py::list names;
             for (const auto& [name, image] : m.maps) names.append(name);
             return py::iter(names);
           })
      .def("keys",
           [](const MaterialHandle& m) {
             std::vector<std::string> names;
             for (const auto& [name, image] : m.maps) names.push_back(name);
             return names;
           })
      .def("items", [](const MaterialHandle& m) { return m.maps; })
      .def("__repr__", [](const MaterialHandle& m) {
        return fmt::format("<Material \"{}\": {}>", m.material->name(), m.material->map_names());
      });
  type.attr("__module__") = "terrazzo";
}

}  // namespace

py::object to_python(const Value& value) {
  if (const auto* image = std::get_if<ImagePtr>(&value))
    return py::cast(std::make_shared<ImageHandle>(ImageHandle{*image}));
  if (const auto* material = std::get_if<MaterialPtr>(&value)) return py::cast(handle_of(*material));
  if (const auto* report = std::get_if<ReportPtr>(&value)) return py::cast(ReportHandle{*report});
  if (const auto* map = std::get_if<UvMapPtr>(&value)) return py::cast(UvMapHandle{*map});
  return py::cast(OtherValue{value});
}

Value from_python(const py::handle& object) {
  if (py::isinstance<ImageHandle>(object)) return py::cast<ImageHandle&>(object).image;
  if (py::isinstance<MaterialHandle>(object)) return py::cast<MaterialHandle&>(object).material;
  if (py::isinstance<ReportHandle>(object)) return py::cast<ReportHandle&>(object).report;
  if (py::isinstance<UvMapHandle>(object)) return py::cast<UvMapHandle&>(object).map;
  if (py::isinstance<OtherValue>(object)) return py::cast<OtherValue&>(object).value;
  throw py::type_error(fmt::format("expected an Image, a Material or another value of terrazzo, found {}",
                                   py::cast<std::string>(py::type::of(object).attr("__name__"))));
}

Value from_python(const py::handle& object, ValueType type) {
  Value value = from_python(object);
  if (!converts(type_of(value), type))
    throw py::type_error(fmt::format("expected a value of type {}, found {}", name_of(type), name_of(type_of(value))));
  return converted(value, type);
}

py::object to_python(const ParamValue& value) {
  return std::visit(
      [](const auto& v) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Size>)
          return py::make_tuple(v.width, v.height);
        else
          return py::cast(v);
      },
      static_cast<const ParamAlternatives&>(value));
}

void bind_values(py::module_& module) {
  bind_images(module);
  bind_material(module);
  py::class_<ReportHandle>(module, "Report", "Figures and small pictures, such as those of a compare node.")
      .def_property_readonly("title", [](const ReportHandle& r) { return r.report->title(); })
      .def_property_readonly("figures", &figures_of, "numbers and texts by name")
      .def_property_readonly("pictures", &pictures_of, "images by name")
      .def_property_readonly("digest", [](const ReportHandle& r) { return r.report->digest().hex(); })
      .attr("__module__") = "terrazzo";
  py::class_<UvMapHandle>(module, "UvMap", "For each pixel of a result, the pixel of the exemplar that it shows.")
      .def_property_readonly("size", [](const UvMapHandle& m) { return pair_of(m.map->size()); })
      .def_property_readonly(
          "exemplar", [](const UvMapHandle& m) { return pair_of(m.map->exemplar()); },
          "(width, height) of the exemplar")
      .def("numpy", &uv_pixels, "A read-only view of the pixels: (height, width, 2) of uint16, x and y. No copy.")
      .def_property_readonly("digest", [](const UvMapHandle& m) { return m.map->digest().hex(); })
      .attr("__module__") = "terrazzo";
  py::class_<OtherValue>(module, "Value", "A value that only nodes use; you can pass it to inputs.")
      .def_property_readonly("type", [](const OtherValue& v) { return name_of(type_of(v.value)); })
      .def_property_readonly("digest", [](const OtherValue& v) { return digest_of(v.value).hex(); })
      .attr("__module__") = "terrazzo";
}

}  // namespace terrazzo::python
