#pragma once

#include <memory>

#include <pybind11/numpy.h>

#include "core/image/image.h"
#include "runner/python/texts.h"

/// Binds images and their pixels as NumPy arrays.
namespace terrazzo::python {

/// An image, and its pixels while an array refers to them.
struct ImageHandle {
  ImagePtr image;
  std::weak_ptr<const Image> pulled{};
};
using ImageHandlePtr = std::shared_ptr<ImageHandle>;

/// A capsule that keeps an object alive for arrays that refer to its memory.
template <typename T>
pybind11::capsule owner_of(const std::shared_ptr<T>& kept) {
  return pybind11::capsule(new std::shared_ptr<T>(kept), [](void* p) { delete static_cast<std::shared_ptr<T>*>(p); });
}

inline pybind11::array read_only(pybind11::array array) {
  pybind11::detail::array_proxy(array.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

void bind_images(pybind11::module_& module);

}  // namespace terrazzo::python
