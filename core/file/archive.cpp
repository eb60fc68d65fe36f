#include "core/file/archive.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/file/file_io.h"
#include "core/file/module_path.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

const ArchiveLibrary& load_archive_library() {
  const fs::path path = module_path("terrazzo_archive.so", "the module for packs");
  void* module = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* symbol = module ? ::dlsym(module, "terrazzo_archive_library") : nullptr;
  if (!symbol) throw Error(fmt::format("cannot load {}: {}", path.string(), ::dlerror()));
  return *reinterpret_cast<const ArchiveLibrary* (*)()>(symbol)();
}

const ArchiveLibrary& archive_library() {
  static const ArchiveLibrary& library = load_archive_library();
  return library;
}

}  // namespace

std::unique_ptr<ArchiveWriter> write_archive(const fs::path& target, ArchiveFormat format) {
  return archive_library().write(target, format);
}

std::unique_ptr<ArchiveReader> read_archive(const fs::path& archive) {
  return archive_library().read(archive);
}

bool is_archive(const fs::path& file) {
  constexpr size_t magic_at = 257;
  char magic[] = "-----";
  try {
    return open_to_read(file).read_at(magic_at, magic, 5, file) == 5 && std::string_view(magic) == "ustar";
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace terrazzo
