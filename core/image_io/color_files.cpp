#include "core/image_io/color_files.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/file/file_io.h"
#include "core/file/file_stamp.h"
#include "core/file/read_guard.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Whether a file is XML, whatever its name: OpenColorIO tries all formats.
bool is_xml(const fs::path& file) {
  std::string start(size_t{256}, '\0');
  start.resize(open_to_read(file).read_at(0, start.data(), start.size(), file));
  const std::string_view other = std::string_view("\xEF\xBB\xBF\xFF\xFE \t\r\n\0", 10);
  const size_t first = start.find_first_not_of(other);
  return first != std::string::npos && start[first] == '<';
}

[[noreturn]] void refuse_reference(const fs::path& file) {
  throw Error(fmt::format(
      "cannot tell which files {} refers to: expected <Reference ... path=\"FILE\"/>, and no entities; write the "
      "operations into one file",
      file.string()));
}

/// The value of `path` in the tag that begins at `at`.
std::string path_in_tag(const fs::path& file, const std::string& xml, size_t at) {
  const std::string tag = xml.substr(at, xml.find('>', at) - at);
  size_t name = tag.find("path");
  while (name != std::string::npos && std::isspace(static_cast<unsigned char>(tag[name - 1])) == 0)
    name = tag.find("path", name + 1);
  const size_t quote = name == std::string::npos ? name : tag.find_first_not_of(" \t\r\n=", name + 4);
  if (quote == std::string::npos || (tag[quote] != '"' && tag[quote] != '\'')) refuse_reference(file);
  const size_t end = tag.find(tag[quote], quote + 1);
  if (end == std::string::npos || tag.find('&') != std::string::npos) refuse_reference(file);
  return tag.substr(quote + 1, end - quote - 1);
}

/// The files that the `Reference` elements of a CLF or CTF file name; none for other files.
std::vector<std::string> references_in(const fs::path& file) {
  if (!is_xml(file)) return {};
  std::string xml = read_file(file);
  std::erase(xml, '\0');  // makes UTF-16 readable
  const std::string lower = lowercase(xml);
  if (lower.find("<!entity") != std::string::npos) refuse_reference(file);
  std::vector<std::string> out;
  for (size_t at = 0; (at = lower.find("<reference", at)) != std::string::npos; at++)
    out.push_back(path_in_tag(file, xml, at));
  return out;
}

class FileFinder {
 public:
  explicit FileFinder(const ColorConfiguration& config) : config_(config), sources_(config.sources()) {
    out_.variables = sources_.variables;
  }

  ColorFiles find() {
    for (const std::string& name : sources_.files) add(name);
    return std::move(out_);
  }

 private:
  /// The place where OpenColorIO finds the file, if it does.
  std::optional<fs::path> place_of(const fs::path& name) const {
    std::error_code missing;
    for (const fs::path folder : sources_.folders)
      if (fs::exists(folder / name, missing)) return (folder / name).lexically_normal();
    return std::nullopt;
  }

  void add(const std::string& name) {
    if (name.empty()) return;
    const std::optional<fs::path> file = place_of(name);
    if (!file || !known_.insert(*file).second) return;
    out_.files.push_back(*file);
    std::error_code missing;
    if (!fs::is_regular_file(*file, missing)) return;
    ReadGuard::check(*file);
    static FileFacts<std::vector<std::string>> references;
    for (const std::string& r : references.of(*file, "references", [&] { return references_in(*file); }))
      add(config_.expanded(r, out_.variables));
  }

  const ColorConfiguration& config_;
  ColorSources sources_;
  std::set<fs::path> known_;
  ColorFiles out_;
};

}  // namespace

ColorFiles find_color_files(const ColorConfiguration& config) {
  return FileFinder(config).find();
}

}  // namespace terrazzo
