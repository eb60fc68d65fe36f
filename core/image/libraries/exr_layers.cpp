#include "core/image/libraries/exr_layers.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace terrazzo {

namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return out;
}

/// Where a channel of that name stands in a pixel; other channels come last, in the order of the file.
size_t place_of(std::string_view channel) {
  constexpr std::array<std::array<std::string_view, 4>, 4> places = {
      {{"r", "red", "x", "u"}, {"g", "green", "y", "v"}, {"b", "blue", "z", ""}, {"a", "alpha", "w", ""}}};
  const std::string name = lower(channel);
  for (size_t i = 0; i < places.size(); i++)
    if (std::find(places[i].begin(), places[i].end(), name) != places[i].end()) return i;
  return places.size();
}

bool is_of_a_picture(std::string_view channel) {
  const std::string name = lower(channel);
  return name == "r" || name == "g" || name == "b" || name == "a";
}

/// "normal.X": "normal" and "X".
std::pair<std::string, std::string> parted(const std::string& channel) {
  const size_t dot = channel.rfind('.');
  if (dot == std::string::npos) return {"", channel};
  return {channel.substr(0, dot), channel.substr(dot + 1)};
}

/// Some programs name parts after the layers in them.
std::string joined(const std::string& part, const std::string& layer) {
  if (part.empty() || layer == part || layer.starts_with(part + ".")) return layer;
  return layer.empty() ? part : part + "." + layer;
}

}  // namespace

std::vector<ExrLayer> exr_layers(const std::vector<ExrPart>& parts) {
  constexpr long most_of_a_picture = 4;
  std::vector<ExrLayer> layers;
  for (size_t p = 0; p < parts.size(); p++) {
    const std::string part = parts.size() > 1 ? parts[p].name : "";
    const std::vector<std::string>& names = parts[p].channels;
    const bool too_many = std::count_if(names.begin(), names.end(), [](const std::string& n) {
                            return parted(n).first.empty();
                          }) > most_of_a_picture;
    const bool has_picture = std::any_of(names.begin(), names.end(), is_of_a_picture);
    const size_t first = layers.size();
    for (size_t c = 0; c < names.size(); c++) {
      const auto [prefix, channel] = parted(names[c]);
      const bool alone = prefix.empty() && too_many && has_picture && !is_of_a_picture(channel);
      const std::string name = joined(part, alone ? channel : prefix);
      auto layer =
          std::find_if(layers.begin() + long(first), layers.end(), [&](const ExrLayer& l) { return l.name == name; });
      if (layer == layers.end()) layer = layers.insert(layer, {name, int(p), {}});
      layer->channels.push_back(int(c));
    }
    for (size_t i = first; i < layers.size(); i++)
      std::stable_sort(layers[i].channels.begin(), layers[i].channels.end(), [&](int a, int b) {
        return place_of(parted(names[size_t(a)]).second) < place_of(parted(names[size_t(b)]).second);
      });
  }
  return layers;
}

}  // namespace terrazzo
