#include "core/image_io/image_libraries.h"

#include <filesystem>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/thread_limits.h"
#include "core/file/module_path.h"
#include "core/image/image_limits.h"

namespace terrazzo {

namespace {

std::filesystem::path libraries_path() {
  return module_path("terrazzo_libraries.so", "the module for JPEG, TIFF and EXR files");
}

/// Releases unmodified pages of loaded libraries, code and tables. Most were needed only for loading; the others are
/// paged in again on use.
void release_library_pages() {
  const auto release = [](dl_phdr_info* library, size_t, void*) {
    const auto page = uintptr_t(::sysconf(_SC_PAGESIZE));
    for (int i = 0; i < library->dlpi_phnum; i++) {
      const ElfW(Phdr)& segment = library->dlpi_phdr[i];
      if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
      const uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
      const uintptr_t end = library->dlpi_addr + segment.p_vaddr + segment.p_filesz;
      // NOLINTNEXTLINE(performance-no-int-to-ptr): the linker gives addresses as numbers
      ::madvise(reinterpret_cast<void*>(begin), end / page * page - begin, MADV_DONTNEED);
    }
    return 0;
  };
  ::dl_iterate_phdr(release, nullptr);
}

/// The module's libraries take 120 MiB while loading, a quarter of it for this library's symbol tables.
void load_largest_first() {
  ::dlopen("libopenvdb.so.10.0", RTLD_LAZY | RTLD_LOCAL);
  release_library_pages();
}

const ImageLibraries& load() {
  const std::filesystem::path path = libraries_path();
  // Libraries that it depends on start threads while they are loaded: OpenVDB's logger starts four.
  require_threads(6);
  if (memory_budget_is_set()) load_largest_first();
  const auto fail = [&] { return Error(fmt::format("cannot load {}: {}", path.string(), ::dlerror())); };
  void* module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) throw fail();
  void* symbol = ::dlsym(module, "terrazzo_image_libraries");
  if (!symbol) throw fail();
  const ImageLibraries& libraries = *reinterpret_cast<const ImageLibraries* (*)()>(symbol)();
  if (memory_budget_is_set()) release_library_pages();
  return libraries;
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
