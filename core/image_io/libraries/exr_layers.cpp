#include "core/image_io/libraries/exr_layers.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace terrazzo {

namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return out;
}

/// The names of a picture's or a vector's channels, in their order in a pixel.
using Places = std::array<std::array<std::string_view, 2>, 4>;
constexpr Places picture = {{{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};
constexpr Places vector = {{{"x", "u"}, {"y", "v"}, {"z", ""}, {"w", ""}}};

size_t place_in(const Places& places, std::string_view channel) {
  const std::string name = lower(channel);
  const auto at = std::ranges::find_if(
      places, [&](const auto& names) { return std::ranges::find(names, std::string_view(name)) != names.end(); });
  return size_t(at - places.begin());
}

/// Other channels come last, in the order of the file.
size_t place_of(std::string_view channel) {
  return std::min(place_in(picture, channel), place_in(vector, channel));
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// A channel's layer and its name there.
struct Name {
  std::string layer;
  std::string channel;
};

/// "normal.X": "normal" and "X".
Name parted_at_dot(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot == std::string::npos) return {"", channel};
  return {channel.substr(0, dot), channel.substr(dot + 1)};
}

/// "normalX", "normal_x": "normal" and the letter, if that may be a channel of a picture or a vector.
Name parted_at_letter(const std::string& channel) {
  if (channel.size() < 2 || place_of(channel.substr(channel.size() - 1)) == picture.size()) return {"", channel};
  std::string layer = channel.substr(0, channel.size() - 1);
  const std::string letter = channel.substr(layer.size());
  while (!layer.empty() && !is_letter(layer.back()) && !(layer.back() >= '0' && layer.back() <= '9')) layer.pop_back();
  return layer.empty() ? Name{"", channel} : Name{layer, letter};
}

/// Some programs name parts after the layers in them.
std::string joined(const std::string& part, const std::string& layer) {
  if (part.empty() || layer == part || layer.starts_with(part + ".")) return layer;
  return layer.empty() ? part : part + "." + layer;
}

/// Numbers are no names: "1", "channel2" beside "channel3".
bool is_numbered(const std::string& channel, const std::vector<std::string>& all) {
  const auto without_number = [](const std::string& name) {
    return name.substr(0, name.find_last_not_of("0123456789") + 1);
  };
  const std::string rest = without_number(channel);
  if (rest.empty() || rest == channel) return rest.empty();
  return std::ranges::count_if(all, [&](const std::string& other) { return without_number(other) == rest; }) > 1;
}

/// The channels of one prefix, by their names after it.
class Siblings {
 public:
  explicit Siblings(const std::vector<std::string>& names) : names_(names) {}

  bool are_picture_or_vector() const { return are_picture() || are_vector(); }
  /// Whether a channel is part of their picture, vector or grey value; else it is a layer of its own, such as depth
  /// beside red, green and blue.
  bool is_part(const std::string& name) const {
    const bool of_picture = place_in(picture, name) < picture.size(), is_alpha = place_in(picture, name) == 3;
    if (is_chroma(name)) return true;
    if (are_picture()) return of_picture;
    if (are_vector()) return is_alpha || place_in(vector, name) < vector.size();
    if (std::ranges::all_of(names_, [](const auto& n) { return place_in(picture, n) < picture.size(); })) return true;
    return lower(name) == "y" || (is_alpha && has(vector, 1)) || is_numbered(name, names_);
  }

 private:
  bool has(const Places& places, size_t place) const {
    return std::ranges::any_of(names_, [&](const std::string& n) { return place_in(places, n) == place; });
  }
  bool are_picture() const { return has(picture, 0) + has(picture, 1) + has(picture, 2) >= 2; }
  bool are_vector() const { return has(vector, 0) && has(vector, 1); }
  /// Chroma beside luminance: OpenEXR keeps them as RY and BY beside Y.
  bool is_chroma(const std::string& name) const {
    return has(vector, 1) && (lower(name) == "ry" || lower(name) == "by");
  }

  std::vector<std::string> names_;
};

/// The layer below a prefix for each of the prefix's channels; empty: the prefix itself.
std::vector<Name> layers_below(const std::vector<std::string>& channels) {
  const Siblings siblings(channels);
  std::map<std::string, std::vector<std::string>> by_stem;  // "normal": X and Y of normalX and normalY
  for (const std::string& c : channels)
    if (const Name parted = parted_at_letter(c); !siblings.is_part(c) && !parted.layer.empty())
      by_stem[parted.layer].push_back(parted.channel);
  std::vector<Name> out;
  for (const std::string& c : channels) {
    const Name parted = parted_at_letter(c);
    const auto group = by_stem.find(parted.layer);
    if (siblings.is_part(c))
      out.push_back({"", c});
    else if (group != by_stem.end() && Siblings(group->second).are_picture_or_vector())
      out.push_back(parted);
    else
      out.push_back({c, c});
  }
  return out;
}

/// Whether the name of a channel that is alone, a letter or a number, does not say what it is.
bool says_nothing(const std::string& channel) {
  return place_of(channel) < picture.size() || is_numbered(channel, {});
}

/// Alpha without a layer belongs to the only other layer. If there are several, it becomes a layer of its own: its
/// picture is missing.
void settle_bare_alpha(std::vector<Name>& names) {
  const auto bare = std::ranges::find(names, "", &Name::layer);
  if (bare == names.end() || place_in(picture, bare->channel) != 3) return;
  if (std::ranges::count(names, "", &Name::layer) > 1 || names.size() == 1) return;
  const Name& other = names[bare == names.begin() ? 1 : 0];
  const bool is_shared = std::ranges::any_of(names, [&](const Name& n) {
    return &n != &*bare && (n.layer != other.layer || place_in(picture, n.channel) == 3);
  });
  constexpr size_t most_channels = 4;
  bare->layer = is_shared || names.size() > most_channels ? bare->channel : other.layer;
}

/// The layer of each channel of a part.
std::vector<Name> names_in(const std::vector<std::string>& channels) {
  if (channels.size() == 1 && says_nothing(channels.front())) return {{"", channels.front()}};
  std::map<std::string, std::vector<size_t>> by_prefix;
  std::vector<Name> out;
  for (const std::string& c : channels) {
    out.push_back(parted_at_dot(c));
    by_prefix[out.back().layer].push_back(out.size() - 1);
  }
  for (const auto& [prefix, members] : by_prefix) {
    if (members.size() == 1 && !prefix.empty() && says_nothing(out[members.front()].channel)) continue;
    std::vector<std::string> below;
    for (const size_t m : members) below.push_back(out[m].channel);
    const std::vector<Name> names = layers_below(below);
    for (size_t i = 0; i < members.size(); i++) {
      const bool is_below = !prefix.empty() && !names[i].layer.empty();
      out[members[i]] = {prefix + (is_below ? "." : "") + names[i].layer, names[i].channel};
    }
  }
  settle_bare_alpha(out);
  return out;
}

}  // namespace

std::vector<ExrLayer> exr_layers(const std::vector<ExrPart>& parts) {
  std::vector<ExrLayer> layers;
  for (size_t p = 0; p < parts.size(); p++) {
    const std::string part = parts.size() > 1 ? parts[p].name : "";
    const std::vector<Name> names = names_in(parts[p].channels);
    const size_t first = layers.size();
    for (size_t c = 0; c < names.size(); c++) {
      const std::string name = joined(part, names[c].layer);
      auto layer =
          std::find_if(layers.begin() + long(first), layers.end(), [&](const ExrLayer& l) { return l.name == name; });
      if (layer == layers.end()) layer = layers.insert(layer, {name, int(p), {}});
      layer->channels.push_back(int(c));
    }
    for (size_t i = first; i < layers.size(); i++)
      std::ranges::stable_sort(layers[i].channels, {}, [&](int c) { return place_of(names[size_t(c)].channel); });
  }
  return layers;
}

}  // namespace terrazzo
