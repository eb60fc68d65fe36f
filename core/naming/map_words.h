#pragma once

#include <array>
#include <string_view>

#include "core/image/image.h"

/// The vocabulary of file names: which words stand for which maps.
namespace terrazzo {

/// The positions at which a word is a keyword.
enum class WordStrength : uint8_t {
  full,     ///< anywhere: "roughness"
  ending,   ///< only as the last word before numbers: "rough", which may also be part of an asset's name
  initial,  ///< only as the last word and after another: "N" in T_Wall_N
};

/// One map in a file: the whole file, or some of its channels.
struct WordPart {
  Semantic semantic = Semantic::data;
  std::string_view map;       ///< the map's name if it differs from the semantic's
  std::string_view channels;  ///< empty: the file is this map alone
  bool inverted = false;
};

/// A word, or several joined words, in lower case without separators.
struct MapWord {
  std::string_view word;
  WordStrength strength;
  int least_channels;  ///< a file of fewer channels cannot be this
  std::array<WordPart, 4> parts;
  int part_count;
};

constexpr MapWord one(std::string_view word, WordStrength strength, Semantic semantic, std::string_view map = "",
                      bool inverted = false) {
  return {word, strength, 1, {WordPart{semantic, map, "", inverted}}, 1};
}

constexpr MapWord packed(std::string_view word, int least_channels, int count, WordPart a, WordPart b, WordPart c = {},
                         WordPart d = {}, WordStrength strength = WordStrength::full) {
  return {word, strength, least_channels, {a, b, c, d}, count};
}

constexpr WordPart occlusion_in(std::string_view c) {
  return {Semantic::ambient_occlusion, "", c};
}
constexpr WordPart roughness_in(std::string_view c) {
  return {Semantic::roughness, "", c};
}
constexpr WordPart smoothness_in(std::string_view c) {
  return {Semantic::roughness, "", c, true};
}
constexpr WordPart metallic_in(std::string_view c) {
  return {Semantic::metallic, "", c};
}

/// Entries of the same word are ordered by the channels they need, most first.
inline constexpr auto map_words = [] {
  using enum Semantic;
  constexpr auto full = WordStrength::full, ending = WordStrength::ending, initial = WordStrength::initial;
  return std::to_array<MapWord>({
      one("basecolor", full, base_color),
      one("basecolour", full, base_color),
      one("albedo", full, base_color),
      one("diffuse", full, base_color),
      one("color", full, base_color),
      one("colour", full, base_color),
      one("maintex", full, base_color),
      one("base", ending, base_color),
      one("diff", ending, base_color),
      one("alb", ending, base_color),
      one("col", ending, base_color),
      one("bc", initial, base_color),
      one("d", initial, base_color),
      packed("albedotransparency", 4, 2, {base_color, "", "rgb"}, {opacity, "", "a"}),
      one("albedotransparency", full, base_color),
      packed("basecoloropacity", 4, 2, {base_color, "", "rgb"}, {opacity, "", "a"}),
      one("normal", full, normal),
      one("normals", full, normal),
      one("nor", ending, normal),
      one("norm", ending, normal),
      one("nrm", ending, normal),
      one("nml", ending, normal),
      one("nm", ending, normal),
      one("n", initial, normal),
      one("height", full, height),
      one("displacement", full, height),
      one("disp", ending, height),
      one("depth", ending, height),
      one("bump", ending, height),
      one("hgt", ending, height),
      one("ht", ending, height),
      one("hm", ending, height),
      one("parallax", ending, height),
      one("h", initial, height),
      one("roughness", full, roughness),
      one("rough", ending, roughness),
      one("rgh", ending, roughness),
      one("r", initial, roughness),
      one("glossiness", full, roughness, "", true),
      one("smoothness", full, roughness, "", true),
      one("gloss", ending, roughness, "", true),
      one("glossy", ending, roughness, "", true),
      one("metallic", full, metallic),
      one("metalness", full, metallic),
      one("metal", initial, metallic),
      one("met", initial, metallic),
      one("m", initial, metallic),
      one("ambientocclusion", full, ambient_occlusion),
      one("occlusion", full, ambient_occlusion),
      one("ao", full, ambient_occlusion),
      one("mixedao", full, ambient_occlusion),
      one("occ", ending, ambient_occlusion),
      one("opacity", full, opacity),
      one("alpha", ending, opacity),
      one("transparency", full, opacity),
      one("emission", full, emission),
      one("emissive", full, emission),
      one("emit", ending, emission),
      one("e", initial, emission),
      one("specular", full, specular),
      one("spec", ending, specular),
      one("refl", ending, specular),
      one("cavity", full, data, "data_cavity"),
      // Labels of parts, as Substance and Blender bake them: a colour means nothing but itself.
      one("id", ending, data, "data_id"),
      one("ids", ending, data, "data_id"),
      one("materialid", full, data, "data_id"),
      one("matid", full, data, "data_id"),
      one("colorid", full, data, "data_id"),
      one("objectid", full, data, "data_id"),
      one("mask", ending, mask),
      packed("ormh", 4, 4, occlusion_in("r"), roughness_in("g"), metallic_in("b"), {height, "", "a"}),
      packed("aormh", 4, 4, occlusion_in("r"), roughness_in("g"), metallic_in("b"), {height, "", "a"}),
      packed("armh", 4, 4, occlusion_in("r"), roughness_in("g"), metallic_in("b"), {height, "", "a"}),
      packed("orm", 3, 3, occlusion_in("r"), roughness_in("g"), metallic_in("b")),
      packed("aorm", 3, 3, occlusion_in("r"), roughness_in("g"), metallic_in("b")),
      packed("arm", 3, 3, occlusion_in("r"), roughness_in("g"), metallic_in("b"), {}, ending),
      packed("rma", 3, 3, roughness_in("r"), metallic_in("g"), occlusion_in("b"), {}, ending),
      packed("rmao", 3, 3, roughness_in("r"), metallic_in("g"), occlusion_in("b")),
      packed("rmo", 3, 3, roughness_in("r"), metallic_in("g"), occlusion_in("b"), {}, ending),
      packed("mrao", 3, 3, metallic_in("r"), roughness_in("g"), occlusion_in("b")),
      packed("mro", 3, 3, metallic_in("r"), roughness_in("g"), occlusion_in("b"), {}, ending),
      packed("mra", 3, 3, metallic_in("r"), roughness_in("g"), occlusion_in("b"), {}, ending),
      packed("ord", 3, 3, occlusion_in("r"), roughness_in("g"), {height, "", "b"}, {}, ending),
      packed("ordp", 3, 3, occlusion_in("r"), roughness_in("g"), {height, "", "b"}),
      packed("specularsmoothness", 4, 2, {specular, "", "rgb"}, smoothness_in("a")),
      one("specularsmoothness", full, specular),
      packed("specularglossiness", 4, 2, {specular, "", "rgb"}, smoothness_in("a")),
      one("specularglossiness", full, specular),
      packed("specgloss", 4, 2, {specular, "", "rgb"}, smoothness_in("a")),
      one("specgloss", full, specular),
      one("metallicsmoothness", full, metallic),
      packed("maskmap", 4, 4, metallic_in("r"), occlusion_in("g"), {mask, "mask_detail", "b"}, smoothness_in("a")),
      packed("mads", 4, 4, metallic_in("r"), occlusion_in("g"), {mask, "mask_detail", "b"}, smoothness_in("a")),
  });
}();

}  // namespace terrazzo
