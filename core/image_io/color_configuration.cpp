#include "core/image_io/color_configuration.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/text.h"
#include "core/base/variables_read.h"
#include "core/file/file_io.h"
#include "core/file/file_stamp.h"
#include "core/file/read_guard.h"
#include "core/image_io/color_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t longest_config = uint64_t{1} << 26;  // bytes; large studios' have a million

/// This variable changes what OpenColorIO computes, whatever the configuration.
constexpr const char* optimization = "OCIO_OPTIMIZATION_FLAGS";

/// The four spaces that need no file. Their names are known here, so that only conversions load OpenColorIO.
class BuiltInColors final : public ColorConfiguration {
 public:
  std::vector<std::string> names() const override { return {"lin_rec709", "srgb_texture", "acescg", "raw"}; }
  std::string find(const std::string& name) const override {
    static const std::map<std::string, std::string> roles = {
        {"reference", "lin_rec709"}, {"scene_linear", "lin_rec709"}, {"data", "raw"}, {"default", "raw"}};
    const std::string wanted = lowercase(name);
    if (const auto role = roles.find(wanted); role != roles.end()) return role->second;
    const std::vector<std::string> known = names();
    return std::find(known.begin(), known.end(), wanted) == known.end() ? "" : wanted;
  }
  Conversion conversion(const std::string& from, const std::string& to) const override {
    static const std::shared_ptr<const ColorConfiguration> colors = image_libraries().load_colors("", "");
    return colors->conversion(from, to);
  }
  std::vector<std::string> files_of(const std::string&, const std::string&) const override { return {}; }
  ColorSources sources() const override { return {}; }
  std::string expanded(const std::string& text, std::map<std::string, std::string>&) const override { return text; }
};

/// The path given or in OCIO; empty for the built-in configuration.
std::string config_path(const std::string& given) {
  if (!given.empty()) return given;
  const char* variable = std::getenv("OCIO");
  return variable ? variable : "";
}

/// The digest of all variables: which ones a configuration uses is unknown until it is read.
Digest environment_digest() {
  Hasher h;
  for (char** v = environ; v && *v; v++) h.add(*v);
  return h.digest();
}

Digest digest_of_content(const fs::path& file) {
  static FileFacts<Digest> digests;
  return digests.of(file, "content", [&] { return content_digest(file).value_or(Digest()); });
}

void add_variables(Hasher& h, const std::map<std::string, std::string>& variables) {
  h.add(int64_t(variables.size()));
  for (const auto& [name, value] : variables) h.add(name).add(value);
}

void require_plain(const fs::path& file) {
  ReadGuard::check(file);
  std::error_code missing;
  const std::string kind = irregular_kind(fs::status(file, missing).type());
  if (!kind.empty()) throw Error(fmt::format("cannot read {}: it is {}; expected a regular file", file.string(), kind));
}

/// Caches configurations by path until they change.
class Configurations {
 public:
  struct Read {
    Digest text, environment, identity;
    std::shared_ptr<const ColorConfiguration> config;
    ColorFiles files;
  };

  /// Throws Error. Does not check whether the files it names are regular.
  Read read(const std::string& path) {
    require_plain(path);
    const std::lock_guard lock(mutex_);
    const Digest text = digest_of_content(path), environment = environment_digest();
    Read& known = known_[path];
    if (!known.config || known.text != text || known.environment != environment) load(known, path, text, environment);
    known.files = find_color_files(*known.config);
    const Digest identity = identity_of(known);
    // The library caches look-up files and their places: load the configuration anew if they have changed.
    if (known.identity != Digest() && known.identity != identity) load(known, path, text, environment);
    known.identity = identity;
    return known;
  }

 private:
  static void load(Read& into, const std::string& path, const Digest& text, const Digest& environment) {
    into = {text, environment, {}, image_libraries().load_colors(path, read_file(path, longest_config)), into.files};
  }

  static Digest identity_of(const Read& read) {
    Hasher h;
    h.add("color configuration 2").add(read.text);
    for (const fs::path& file : read.files.files) h.add(file.string()).add(digest_of_content(file));
    add_variables(h, read.files.variables);
    return h.digest();
  }

  std::mutex mutex_;
  std::map<std::string, Read> known_;
};

Configurations& configurations() {
  static Configurations all;
  return all;
}

/// Variables that the library reads whatever the configuration.
std::map<std::string, std::string> variables_of_library() {
  const char* flags = std::getenv(optimization);
  return flags ? std::map<std::string, std::string>{{optimization, flags}} : std::map<std::string, std::string>();
}

/// The identity together with the library's variables.
Digest with_library(const Digest& identity) {
  const std::map<std::string, std::string> variables = variables_of_library();
  if (variables.empty()) return identity;
  Hasher h;
  h.add(identity);
  add_variables(h, variables);
  return h.digest();
}

Error about(const std::string& path, const Error& e) {
  return Error(fmt::format("cannot read the OpenColorIO configuration {}: {}", path, e.what()));
}

}  // namespace

Configuration color_configuration(const std::string& given) {
  const std::string path = config_path(given);
  if (path.empty())
    return {std::make_shared<BuiltInColors>(), "the built-in configuration",
            with_library(Hasher().add("built-in 1").digest())};
  try {
    const Configurations::Read read = configurations().read(path);
    for (const fs::path& file : read.files.files) require_plain(file);
    return {read.config, path, with_library(read.identity)};
  } catch (const Error& e) {
    throw about(path, e);
  }
}

ColorConfiguration::Conversion color_conversion(const Configuration& c, const std::string& from,
                                                const std::string& to) {
  ColorConfiguration::Conversion out = c.config->conversion(from, to);
  const std::vector<std::string> read = c.config->files_of(from, to);
  if (read.empty()) return out;
  const std::vector<fs::path> known = find_color_files(*c.config).files;
  for (const std::string& file : read)
    if (std::ranges::find(known, fs::path(file).lexically_normal()) == known.end())
      throw Error(
          fmt::format("OpenColorIO reads {}, which cannot be foreseen from the configuration; name the "
                      "file there",
                      file));
  return out;
}

std::vector<fs::path> files_of_configuration(const std::string& given) {
  for (const auto& [name, value] : variables_of_library()) VariablesRead::note(name, value);
  const std::string path = config_path(given);
  if (path.empty()) return {};
  std::vector<fs::path> files = {path};
  try {
    const ColorFiles named = configurations().read(path).files;
    files.insert(files.end(), named.files.begin(), named.files.end());
    for (const auto& [name, value] : named.variables) VariablesRead::note(name, value);
  } catch (const Error&) {
    return files;  // whoever uses the configuration reports what is wrong with it
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace terrazzo
