#include "nodes/common/exemplar_lint.h"

#include <map>
#include <mutex>

#include <fmt/format.h>

#include "core/filter/exemplar_faults.h"
#include "core/image_io/image_file.h"

namespace terrazzo {

namespace {

/// Remembered by path, size and time of change: an editor asks after every edit of a graph.
ExemplarFaults faults_in(const std::filesystem::path& file) {
  struct Known {
    std::filesystem::file_time_type changed;
    uintmax_t size;
    ExemplarFaults faults;
  };
  constexpr size_t most = 64;
  static std::mutex mutex;
  static std::map<std::filesystem::path, Known> all;
  std::error_code no_time, no_size;
  const auto changed = std::filesystem::last_write_time(file, no_time);
  const uintmax_t size = std::filesystem::file_size(file, no_size);
  {
    const std::lock_guard lock(mutex);
    const auto at = all.find(file);
    if (!no_time && !no_size && at != all.end() && at->second.changed == changed && at->second.size == size)
      return at->second.faults;
  }
  const ExemplarFaults found = exemplar_faults(*read_image(file, {}, [](const std::string&) {}));
  const std::lock_guard lock(mutex);
  if (all.size() >= most) all.clear();
  all.insert_or_assign(file, Known{changed, size, found});
  return found;
}

}  // namespace

std::string lone_feature_message(const std::string& subject, const LoneFeature& lone) {
  return fmt::format(
      "{}: the exemplar shows something around ({}, {}) only once; a result repeats it, and the eye finds that. Crop "
      "it off (crop), paint it over (inpaint), or leave it out by a mask",
      subject, lone.x, lone.y);
}

Lints lint_of_colour(const std::string& subject, const std::filesystem::path& file) {
  Lints out;
  try {
    const ExemplarFaults found = faults_in(file);
    if (found.is_mostly_one_colour())
      out.push_back({fmt::format(
          "{}: {:.0f} % of the exemplar are one colour: a background or a border? Crop it (crop), or leave it out by "
          "a mask",
          subject, 100 * found.one_colour)});
    if (found.is_lit_from_a_side())
      out.push_back(
          {.message = fmt::format(
               "{}: the exemplar is {:.0f} % brighter at the {} than at the {}: light that was baked in shows "
               "as blotches in a result. The node \"delight\" takes it out; a photograph in flat light is better",
               subject, 100 * found.brightening, found.bright_side, found.dark_side),
           .answered_by = "delight"});
    if (found.lone.is_seen()) out.push_back({lone_feature_message(subject, found.lone)});
  } catch (const Error&) {
    // reading reports it
  }
  return out;
}

}  // namespace terrazzo
