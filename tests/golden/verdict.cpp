#include "tests/golden/verdict.h"

#include <algorithm>

#include <fmt/format.h>

#include "nodes/common/registry.h"

namespace terrazzo::test {

namespace {

constexpr const char* anew = "record it anew with tests/golden/regenerate.sh";

std::string described(const Content& c) {
  return fmt::format("{} (mean {:.6g}, deviation {:.6g})", c.digest.hex().substr(0, 8), c.mean, c.deviation);
}

/// Node types that run the synthesis share its version.
std::string place_of_version(const std::string& type) {
  const NodeType* known = find_node_type(type);
  return known && !known->steps.empty() ? "synthesis_version in core/synthesis/steps.h" : "in its file";
}

std::string difference(const GoldenLine& recorded, const GoldenLine& now) {
  const std::string what = fmt::format("{}: \"{}\" gives another {} than recorded: {} instead of {}. ", now.name,
                                       now.type, now.port, described(now.content), described(recorded.content));
  if (recorded.type != now.type) return what + fmt::format("It was a \"{}\"; {}.", recorded.type, anew);
  if (recorded.version != now.version)
    return what + fmt::format("Its version went from {} to {}, as it should; {}.", recorded.version, now.version, anew);
  return what + fmt::format("Its version is still {}: undo the change, or raise its version ({}) and {}.", now.version,
                            place_of_version(now.type), anew);
}

}  // namespace

Verdict::Verdict(std::map<std::string, GoldenFile> recorded, std::string libraries)
    : recorded_(std::move(recorded)), libraries_(std::move(libraries)) {}

bool Verdict::differs(const GoldenFile& file, const GoldenLine& recorded, const GoldenLine& now, bool pixelwise) const {
  if (recorded.content.digest == now.content.digest) return false;
  return file.libraries == libraries_ || !nearly_same(recorded.content, now.content, pixelwise);
}

bool Verdict::follows(const GoldenCase& golden) const {
  return std::any_of(golden.sources.begin(), golden.sources.end(),
                     [&](const Wire& w) { return changed_.count(w) > 0; }) ||
         std::any_of(golden.files_in.begin(), golden.files_in.end(),
                     [&](const auto& f) { return changed_files_.count(f) > 0; });
}

void Verdict::judge(const GoldenCase& golden) {
  const GoldenFile& file = recorded_[golden.file];
  const bool follower = follows(golden);
  bool changed = false;
  for (const GoldenLine& now : golden.lines) {
    seen_[golden.file].insert({now.name, now.port});
    const GoldenLine* recorded = file.find(now.name, now.port);
    if (!recorded) {
      complaints_.push_back(fmt::format("{}: nothing is recorded of {}; {}.", now.name, now.port, anew));
    } else if (differs(file, *recorded, now, !golden.decided)) {
      if (!follower) complaints_.push_back(difference(*recorded, now));
    } else if (recorded->version != now.version && !follower) {
      if (versions_said_.insert(now.type).second)
        complaints_.push_back(fmt::format("{}: the version of \"{}\" went from {} to {}; {}.", now.name, now.type,
                                          recorded->version, now.version, anew));
      continue;
    } else {
      continue;
    }
    changed = true;
    changed_.insert({now.name, now.port});
  }
  if (changed) changed_files_.insert(golden.files_out.begin(), golden.files_out.end());
  if (changed && follower) followers_++;
}

void Verdict::judge_leftovers(const std::vector<std::string>& documents) {
  for (const auto& [name, file] : recorded_)
    for (const GoldenLine& l : file.lines) {
      const bool asked =
          std::find(documents.begin(), documents.end(), l.name.substr(0, l.name.find('/'))) != documents.end();
      if (asked && !seen_[name].count({l.name, l.port}))
        complaints_.push_back(
            fmt::format("{}: {}.txt has results of {}, which no case gives any more; {}.", l.name, name, l.port, anew));
    }
}

}  // namespace terrazzo::test
