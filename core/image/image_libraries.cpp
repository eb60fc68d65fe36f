#include "core/image/image_libraries.h"

#include <filesystem>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/file/module_path.h"

namespace terrazzo {

namespace {

std::filesystem::path libraries_path() {
  return module_path("terrazzo_libraries.so", "the module for JPEG, TIFF and EXR files");
}

const ImageLibraries& load() {
  const std::filesystem::path path = libraries_path();
  const auto fail = [&] { return Error(fmt::format("cannot load {}: {}", path.string(), ::dlerror())); };
  void* module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) throw fail();
  void* symbol = ::dlsym(module, "terrazzo_image_libraries");
  if (!symbol) throw fail();
  return *reinterpret_cast<const ImageLibraries* (*)()>(symbol)();
}

}  // namespace

void require_image_libraries() {
  libraries_path();
}

const ImageLibraries& image_libraries() {
  static const ImageLibraries& libraries = load();
  return libraries;
}

}  // namespace terrazzo
