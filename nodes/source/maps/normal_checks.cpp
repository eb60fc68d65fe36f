#include "nodes/source/maps/normal_checks.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/filter/normal_convention.h"

namespace terrazzo {

namespace {

std::string_view name_of_convention(NormalY y) {
  return y == NormalY::up ? "up (OpenGL)" : "down (DirectX)";
}

/// The convention according to the pixels, with the evidence.
struct NormalJudgement {
  std::optional<NormalY> normal_y;
  std::string grounds;
};

NormalJudgement judged(const Image& normal, const ImagePtr& height) {
  if (height) {
    const ConventionEvidence e = convention_from_height(normal, *height);
    if (e.normal_y)
      return {e.normal_y, fmt::format("judged by the height map (correlation with its slopes x {:.2f}, y {:.2f})",
                                      e.along_x, e.along_y)};
  }
  const ConventionEvidence e = convention_from_curl(normal);
  return {e.normal_y, fmt::format("judged by the normals themselves (correlation {:.2f})", e.along_y)};
}

/// Judges the convention by pixels; notes the result.
NormalY detect_convention(const Image& normal, const ImagePtr& height, std::vector<std::string>& notes) {
  const NormalJudgement found = judged(normal, height);
  if (found.normal_y) {
    notes.push_back(fmt::format("normal: green points {}, {}", name_of_convention(*found.normal_y), found.grounds));
    return *found.normal_y;
  }
  notes.push_back(
      "normal: neither its name nor its pixels say whether green points up (OpenGL) or down (DirectX); up is assumed. "
      "Set `normal_y` if that is wrong");
  return NormalY::up;
}

/// The name takes precedence, with a warning if the pixels contradict it.
void check_named_convention(const RecognisedMap& source, const Image& normal, const ImagePtr& height,
                            std::vector<std::string>& notes) {
  const NormalJudgement found = judged(normal, height);
  if (found.normal_y && *found.normal_y != *source.normal_y)
    notes.push_back(fmt::format(
        "normal: {} says that green points {}, but it seems to point {}, {}. The former is used; set "
        "`normal_y` to \"{}\" if it is wrong",
        source.said_by.empty() ? "the name " + source.file : fmt::format("{} ({})", source.said_by, source.file),
        name_of_convention(*source.normal_y), name_of_convention(*found.normal_y), found.grounds,
        *found.normal_y == NormalY::up ? "up" : "down"));
}

/// Other errors of normals than the green convention.
void warn_of_misfits(const std::string& map, const Image& normal, const ImagePtr& height,
                     std::vector<std::string>& notes) {
  if (const double blue = mean_blue(normal); blue < 0.5)
    notes.push_back(
        fmt::format("{}{}: its blue channel is below one half (mean {:.2f}): the normals point into the "
                    "surface. Invert blue, or export the map again",
                    warning_mark, map, blue));
  if (!height) return;
  const ConventionEvidence e = convention_from_height(normal, *height);
  if (e.normal_y && e.height_inverted)
    notes.push_back(fmt::format(
        "{}{}: red runs against the slopes of the height map (correlation x {:.2f}, y {:.2f}): the height map is dark "
        "where the surface is high, or {}. Invert the one that is wrong; {} inverts the height map",
        warning_mark, map, e.along_x, e.along_y,
        e.along_y > 0 ? "green points up and red is flipped" : "the normals are turned by 180 degrees",
        advice_to_interpret("height", "inverted")));
  using enum NormalMisfit::Kind;
  const NormalMisfit misfit = misfit_with_height(normal, *height);
  const auto turned = [&](std::string_view how) {
    notes.push_back(
        fmt::format("{}{}: it fits the height map only if its picture was {} (correlation {:.2f}, {:.2f}). "
                    "Turn or mirror it back in its file, or leave one of the two maps out",
                    warning_mark, map, how, misfit.along_x, misfit.along_y));
  };
  switch (misfit.kind) {
    case none:
      return;
    case channels_swapped:
      notes.push_back(
          fmt::format("{}{}: red follows the height map's slopes along y (correlation {:.2f}), green those along x "
                      "({:.2f}): red and green are swapped, or the normals are turned by 90 degrees. Export the map "
                      "again, or leave it out",
                      warning_mark, map, misfit.along_x, misfit.along_y));
      return;
    case turned_90:
      return turned("turned clockwise by 90 degrees");
    case turned_180:
      return turned("turned by 180 degrees");
    case turned_270:
      return turned("turned counter-clockwise by 90 degrees");
    case mirrored_x:
      return turned("mirrored left to right");
    case mirrored_y:
      return turned("mirrored top to bottom");
  }
}

}  // namespace

void settle_normals(const std::string& wish, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                    std::vector<std::string>& notes) {
  ImagePtr height;
  for (const Map& m : maps)
    if (m.image->info().semantic == Semantic::height) height = m.image;
  for (Map& m : maps) {
    if (m.image->info().semantic != Semantic::normal) continue;
    ImageInfo info = m.image->info();
    const auto source =
        std::find_if(sources.begin(), sources.end(), [&](const RecognisedMap& s) { return s.map == m.name; });
    if (wish != "auto")
      info.normal_y = wish == "up" ? NormalY::up : NormalY::down;
    else if (source->normal_y) {
      info.normal_y = *source->normal_y;
      check_named_convention(*source, *m.image, height, notes);
    } else
      info.normal_y = detect_convention(*m.image, height, notes);
    warn_of_misfits(m.name, *m.image, height, notes);
    m.image = Image::redescribed(m.image, info);
  }
}

}  // namespace terrazzo
