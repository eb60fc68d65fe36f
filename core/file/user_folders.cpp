#include "core/file/user_folders.h"

#include <cstdlib>

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include "core/base/error.h"

namespace terrazzo {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::filesystem::path user_folder(const char* variable, const char* base, const char* usual) {
  if (const std::string given = environment(variable); !given.empty()) return given;
  // Relative folders are to be ignored, says the XDG base directory specification.
  if (const std::string folder = environment(base); folder.starts_with('/'))
    return std::filesystem::path(folder) / "terrazzo";
  std::string home = environment("HOME");
  if (const passwd* user = home.empty() ? ::getpwuid(::getuid()) : nullptr) home = user->pw_dir;
  if (home.empty()) throw Error(fmt::format("there is no home folder; set ${} to a folder", variable));
  return std::filesystem::path(home) / usual / "terrazzo";
}

}  // namespace terrazzo
