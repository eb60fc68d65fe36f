#include "runner/editor/previews/picture_board.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/editor/previews/shown_values.h"

namespace terrazzo {

namespace {

using Json = nlohmann::ordered_json;

constexpr int thumbnail_side = 96, side_of_other_maps = 256;

/// The value and all that decides how it is shown.
std::string identity_of(const Wish& wish, const Digest& value) {
  return fmt::format("{} {} {} {} {}", value.hex(), wish.side, wish.map, wish.exact, wish.is_looked_at);
}

std::string url_of(const std::string& digest) {
  return "/picture/" + digest;
}

Json described(const Wish& wish, const std::string& output, const std::string& map) {
  Json out = {{"level", wish.at.level}, {"node", wish.at.node}, {"output", output}};
  if (!map.empty()) out["map"] = map;
  return out;
}

void check(const std::atomic<bool>& cancelled) {
  if (cancelled) throw Cancelled();
}

}  // namespace

PictureBoard::PictureBoard(PictureStore& store, PublishEvent publish) : store_(store), publish_(std::move(publish)) {}

bool PictureBoard::confirm(const Wish& wish, const std::map<std::string, Digest>& outputs) {
  std::vector<std::string> events;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [output, value] : outputs) {
      const auto at = shown_.find({wish.at, output});
      if (at == shown_.end() || at->second.identity != identity_of(wish, value)) return false;
      for (const auto& [map, event] : at->second.events) events.push_back(event);
    }
  }
  for (const std::string& event : events) publish_("picture", Json::parse(event), false);
  return true;
}

void PictureBoard::send(const Wish& wish, const std::string& output, const std::string& map, const Json& event,
                        const std::atomic<bool>& cancelled) {
  const std::lock_guard order(sending_);
  check(cancelled);
  {
    const std::lock_guard lock(mutex_);
    shown_[{wish.at, output}].events[map] = event.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  publish_("picture", event, false);
}

void PictureBoard::show(const Wish& wish, const std::string& output, const Value& value,
                        const std::atomic<bool>& cancelled) {
  const Task task(&cancelled, {});
  const CurrentTask scope(task);
  std::vector<ShownImage> images = shown_images(value, wish.side);
  const auto wanted = std::ranges::find(images, wish.map, &ShownImage::map);
  if (!wish.map.empty() && wanted != images.end()) std::rotate(images.begin(), wanted, wanted + 1);
  if (!wish.is_looked_at && images.size() > 1) images.resize(1);
  std::set<std::string> maps;
  for (size_t i = 0; i < images.size(); i++) {
    check(cancelled);
    const ShownImage& one = images[i];
    const bool is_main = i == 0 || wish.map.empty();
    const bool is_exact = wish.exact && is_main;
    const int side = is_exact  ? std::numeric_limits<int>::max()
                     : is_main ? wish.side
                               : std::min(wish.side, side_of_other_maps);
    const ImagePtr display = shrunk_for_display(one.image, side);
    check(cancelled);
    const std::string digest = store_.add(picture_file(*display, is_exact), one.has_values ? one.image : one.values);
    const std::string small = store_.add(picture_file(*shrunk_for_display(display, thumbnail_side)));
    Json event = described(wish, output, one.map);
    event.update({{"digest", digest},
                  {"url", url_of(digest)},
                  {"small", url_of(small)},
                  {"width", one.size.width},
                  {"height", one.size.height},
                  {"of", is_exact ? "full" : "preview"},
                  {"coarse", false},
                  {"semantic", one.semantic}});
    if (one.exemplar) event["exemplar"] = {{"width", one.exemplar->width}, {"height", one.exemplar->height}};
    send(wish, output, one.map, event, cancelled);
    maps.insert(one.map);
  }
  const std::lock_guard lock(mutex_);
  Output& shown = shown_[{wish.at, output}];
  shown.identity = identity_of(wish, digest_of(value));
  std::erase_if(shown.events, [&](const auto& event) { return !maps.contains(event.first); });
}

void PictureBoard::show_coarse(const Wish& wish, const Port& output, const ImagePtr& image, Size full,
                               const std::atomic<bool>& cancelled) {
  const std::string digest = store_.add(picture_file(*image));
  // What shows a material takes the place of its base colour, which is seen first.
  const bool is_drawing = image->info().color_space == "raw";
  const std::string_view base_color = name_of(Semantic::base_color);
  Json event = described(wish, output.name, std::string(output.type == ValueType::material ? base_color : ""));
  event.update({{"digest", digest},
                {"url", url_of(digest)},
                {"small", url_of(digest)},
                {"width", full.width},
                {"height", full.height},
                {"of", "preview"},
                {"coarse", true},
                {"semantic", is_drawing ? "uv" : base_color}});
  const std::lock_guard order(sending_);
  check(cancelled);
  publish_("picture", event, false);
  const std::lock_guard lock(mutex_);
  shown_[{wish.at, output.name}].identity.clear();
}

void PictureBoard::retain(const std::vector<Wish>& wishes) {
  const std::lock_guard lock(mutex_);
  std::erase_if(shown_, [&](const auto& entry) {
    return std::ranges::find(wishes, entry.first.first, &Wish::at) == wishes.end();
  });
}

std::vector<std::string> PictureBoard::current() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> out;
  for (const auto& [place, output] : shown_)
    for (const auto& [map, event] : output.events) out.push_back(event);
  return out;
}

}  // namespace terrazzo
