#include <cmath>
#include <new>

#include <fmt/format.h>

#include "core/block_file/block_file.h"
#include "core/exemplar/features.h"
#include "core/node/serialize.h"
#include "core/node/serialize_check.h"
#include "core/node/stored_pixels.h"

namespace terrazzo {

namespace {

/// Runs a factory on data from a file and converts its errors to DamagedFile.
template <typename Make>
auto checked(const Make& make) {
  try {
    return make();
  } catch (const DamagedFile&) {
    throw;
  } catch (const Error& e) {
    throw DamagedFile(e.what());
  } catch (const std::logic_error& e) {
    throw DamagedFile(e.what());
  }
}

/// Reads values from a block file. Treats all content as hostile.
class ValueReader {
 public:
  explicit ValueReader(std::shared_ptr<const BlockFile> file) : file_(std::move(file)), in_(file_->description()) {}

  Value value() {
    Value v = any(file_->header().type);
    in_.expect_end();
    require_sound(digest_of(v) == file_->header().digest, "its content does not have the digest it says");
    return v;
  }

  Size exemplar_of_index() {
    require_sound(file_->header().type == uint32_t(ValueType::index), "it holds no index");
    return appearance_start().exemplar;
  }

 private:
  Value any(uint32_t type) {
    require_sound(type < value_type_names.size(), "it holds a value of an unknown type");
    switch (static_cast<ValueType>(type)) {
      case ValueType::image:
        return image();
      case ValueType::material:
        return material();
      case ValueType::features:
        return features();
      case ValueType::appearance:
        return appearance();
      case ValueType::index:
        return index();
      case ValueType::uv_map:
        return uv_map();
      case ValueType::report:
        return report();
    }
    throw DamagedFile("it holds a value of an unknown type");
  }

  Size size() {
    Size s;
    s.width = in_.get<int32_t>();
    s.height = in_.get<int32_t>();
    // Keeps every product of an area with channels or sizes of elements within 64 bits.
    require_sound(s.width > 0 && s.height > 0 && s.area() <= int64_t{1} << 48, "a size in it is impossible");
    return s;
  }

  const BlockStream& stream(uint32_t number, StreamKind kind) const {
    require_sound(number < file_->streams().size() && file_->streams()[number].kind == kind, "a stream is missing");
    return file_->streams()[number];
  }

  ImagePtr image() {
    ImageInfo info;
    info.size = size();
    info.channels = in_.get_below<uint8_t>(5);
    require_sound(info.channels > 0, "an image has no channels");
    info.semantic = static_cast<Semantic>(in_.get_below<uint8_t>(uint8_t(semantic_names.size())));
    info.color_space = in_.get_text();
    info.depth = static_cast<Depth>(in_.get_below<uint8_t>(4));
    info.normal_y = static_cast<NormalY>(in_.get_below<uint8_t>(2));
    const auto digest = in_.get<Digest>();
    const auto number = in_.get<uint32_t>();
    require_sound(stream(number, StreamKind::samples).elements == uint64_t(info.size.area()) * uint64_t(info.channels),
                  "an image has another size than its pixels");
    return Image::with_digest(info, digest, stored_pixels(file_, number, info.size, info.channels));
  }

  MaterialPtr material() {
    std::string name = in_.get_text();
    std::vector<Map> maps;
    const auto count = in_.get<uint32_t>();
    for (uint32_t i = 0; i < count; i++) {
      std::string map = in_.get_text();
      maps.push_back({std::move(map), image()});
    }
    const auto width = in_.get<double>(), height = in_.get<double>();
    require_sound(width >= 0 && width <= largest_extent && height >= 0 && height <= largest_extent,
                  "a surface has an impossible size");
    return checked([&] { return Material::make(std::move(name), std::move(maps), {width, height}); });
  }

  double component() {
    const auto v = in_.get<double>();
    require_sound(std::isfinite(v), "a lattice has a component that is not a number");
    return v;
  }

  Lattice lattice() {
    Lattice l;
    l.rank = in_.get_below<uint8_t>(3);
    for (double* v : {&l.first.x(), &l.first.y(), &l.second.x(), &l.second.y(), &l.certainty}) *v = component();
    require_sound(l.is_valid(), "a lattice has no extent");
    return l;
  }

  Repeats repeats() {
    Repeats r = lattice();
    for (int* v : {&r.streaks.x, &r.streaks.y}) *v = in_.get<uint8_t>();
    const int count = in_.get<uint8_t>();
    for (int i = 0; i < count; i++) {
      LatticePart p;
      for (int* v : {&p.place.x, &p.place.y, &p.place.width, &p.place.height}) *v = in_.get<int32_t>();
      p.lattice = lattice();
      p.shown = lattice();
      for (double* v : {&p.start.x(), &p.start.y()}) *v = component();
      r.parts.push_back(p);
    }
    return r;
  }

  /// `of`: the size that they must have.
  ElementsPtr elements(Size of) {
    if (in_.get_below<uint8_t>(2) == 0) return nullptr;
    auto out = std::make_shared<Elements>();
    out->size = size();
    require_sound(out->size == of, "elements have another size than the exemplar");
    out->count = in_.get<int32_t>();
    require_sound(out->count > 0 && out->count <= most_elements, "a number of elements is out of range");
    out->certainty = in_.get<double>();
    require_sound(out->certainty >= 0 && out->certainty <= 1, "a certainty is out of range");
    out->at = array<uint16_t>(uint64_t(out->size.area()));
    for (const uint16_t e : out->at) require_sound(e < out->count, "a pixel belongs to no element");
    return out;
  }

  FeaturesPtr features() {
    const Size s = size();
    const bool wraps = in_.get_below<uint8_t>(2) != 0;
    const Repeats repeated = repeats();
    check_repeats(repeated, s);
    ElementsPtr parts = elements(s);
    std::vector<FeatureImage> images;
    const auto count = in_.get<uint32_t>();
    for (uint32_t i = 0; i < count; i++) {
      FeatureImage f{image(), {}};
      f.map = in_.get_text();
      for (int c = 0; c < f.image->channels(); c++) f.weights.push_back(in_.get<double>());
      images.push_back(std::move(f));
    }
    const ImagePtr mask = in_.get_below<uint8_t>(2) != 0 ? image() : nullptr;
    return checked([&] { return Features::make(s, std::move(images), wraps, repeated, mask, std::move(parts)); });
  }

  /// `count` items. Allocates only as much as the file really contains.
  template <typename T>
  std::vector<T> array(uint64_t count) {
    const BlockStream& s = stream(in_.get<uint32_t>(), StreamKind::bytes);
    require_sound(s.elements / sizeof(T) == count && s.elements % sizeof(T) == 0, "an array has the wrong length");
    static_assert(bytes_per_block % sizeof(T) == 0);
    std::vector<T> items;
    for (const StoredBlock& b : s.blocks) {
      const RawBlock raw = file_->read(b);
      const size_t at = items.size();
      items.resize(at + raw.bytes.size() / sizeof(T));
      std::memcpy(items.data() + at, raw.bytes.data(), raw.bytes.size());
    }
    return items;
  }

  AppearanceLevel level() {
    AppearanceLevel l;
    l.size = size();
    l.dimensions = in_.get<int32_t>();
    require_sound(l.dimensions >= 0 && l.dimensions <= appearance_dimensions, "a number of dimensions is out of range");
    l.scale = in_.get<double>();
    l.retained = in_.get<double>();
    require_sound(std::isfinite(l.scale) && std::isfinite(l.retained), "a scale is not a number");
    l.vectors = array<AppearanceVector>(uint64_t(l.size.area()));
    for (const AppearanceVector& v : l.vectors)
      for (const int c : v)
        require_sound(c >= -appearance_limit && c <= appearance_limit, "a component is out of range");
    l.usable = array<uint8_t>(array_length<uint8_t>());
    require_sound(l.usable.empty() || l.usable.size() == l.vectors.size(), "a mask has another size than its level");
    const uint64_t inputs = array_length<float>();
    l.mean = array<float>(inputs);
    l.basis = array<float>(inputs * uint64_t(l.dimensions));
    return l;
  }

  /// The length of the array that comes next.
  template <typename T>
  uint64_t array_length() const {
    ByteReader ahead = in_;
    return stream(ahead.get<uint32_t>(), StreamKind::bytes).elements / sizeof(T);
  }

  FingerprintPtr fingerprint() {
    if (in_.get_below<uint8_t>(2) == 0) return nullptr;
    auto out = std::make_shared<Fingerprint>();
    out->cells = size();
    require_sound(std::max(out->cells.width, out->cells.height) <= Fingerprint::most_cells,
                  "a fingerprint is too large");
    const auto count = in_.get<uint32_t>();
    for (uint32_t i = 0; i < count; i++) {
      Fingerprint::Channel c;
      c.map = in_.get_text();
      c.channel = in_.get_below<uint8_t>(4);
      c.means = array<uint8_t>(uint64_t(out->cells.area()));
      out->channels.push_back(std::move(c));
    }
    return out;
  }

  /// What stands before an appearance's levels.
  struct AppearanceStart {
    Size exemplar;
    int channels = 0;
    bool wraps = false;
    Repeats repeats;
    FingerprintPtr maps;
    ElementsPtr elements;
    uint32_t levels = 0;
  };

  AppearanceStart appearance_start() {
    AppearanceStart a;
    a.exemplar = size();
    a.channels = in_.get<int32_t>();
    require_sound(a.channels > 0, "an appearance has no channels");
    a.wraps = in_.get_below<uint8_t>(2) != 0;
    a.repeats = repeats();
    a.maps = fingerprint();
    check_repeats(a.repeats, a.exemplar);
    a.elements = elements(a.exemplar);
    a.levels = in_.get<uint32_t>();
    require_sound(a.levels > 0, "an appearance has no levels");
    return a;
  }

  AppearancePtr appearance() {
    AppearanceStart start = appearance_start();
    std::vector<AppearanceLevel> levels;
    for (uint32_t i = 0; i < start.levels; i++) levels.push_back(level());
    check_levels(levels, start.channels);
    require_sound(start.repeats.streaks.shortened(start.exemplar) == levels.front().size,
                  "its finest level has another size than the exemplar");
    return checked([&] {
      return Appearance::make(std::move(levels), start.channels, start.wraps, start.repeats, std::move(start.maps),
                              std::move(start.elements), start.exemplar);
    });
  }

  IndexPtr index() {
    AppearancePtr of = appearance();
    std::vector<SimilarSets> levels;
    for (const AppearanceLevel& l : of->levels()) {
      SimilarSets s;
      s.per_pixel = in_.get<int32_t>();
      const auto area = uint64_t(l.size.area());
      require_sound(s.per_pixel >= 0 && s.per_pixel <= most_similar, "a number of similar pixels is out of range");
      s.positions = array<uint32_t>(area * uint64_t(s.per_pixel));
      for (const uint32_t p : s.positions) require_sound(p < area, "a similar pixel lies outside the exemplar");
      levels.push_back(std::move(s));
    }
    return checked([&] { return Index::make(std::move(of), std::move(levels)); });
  }

  UvMapPtr uv_map() {
    const Size s = size(), exemplar = size();
    UvWraps wraps;
    for (bool* w : {&wraps.x, &wraps.y, &wraps.exemplar}) *w = in_.get_below<uint8_t>(2) != 0;
    FingerprintPtr maps = fingerprint();
    auto pixels = array<ExemplarPixel>(uint64_t(s.area()));
    return checked([&] { return UvMap::make(s, exemplar, std::move(pixels), wraps, std::move(maps)); });
  }

  ReportPtr report() {
    std::string title = in_.get_text();
    std::vector<Report::Figure> figures;
    const auto figure_count = in_.get<uint32_t>();
    for (uint32_t i = 0; i < figure_count; i++) {
      Report::Figure f;
      f.name = in_.get_text();
      f.help = in_.get_text();
      if (in_.get_below<uint8_t>(2) == 0)
        f.value = in_.get<double>();
      else
        f.value = in_.get_text();
      figures.push_back(std::move(f));
    }
    std::vector<Report::Picture> pictures;
    const auto picture_count = in_.get<uint32_t>();
    for (uint32_t i = 0; i < picture_count; i++) {
      std::string name = in_.get_text();
      pictures.push_back({std::move(name), image()});
    }
    return checked([&] { return Report::make(std::move(title), std::move(figures), std::move(pictures)); });
  }

  std::shared_ptr<const BlockFile> file_;
  ByteReader in_;
};

/// Runs `read` and adds the file's name to its errors.
template <typename Read>
auto naming(const std::filesystem::path& path, const Read& read) {
  try {
    return read();
  } catch (const OutdatedFile& e) {
    throw OutdatedFile(fmt::format("{} cannot be used: {}", path.string(), e.what()));
  } catch (const DamagedFile& e) {
    throw DamagedFile(fmt::format("{} cannot be used: {}", path.string(), e.what()));
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("cannot read {}: there is not enough memory for what is in it", path.string()));
  }
}

}  // namespace

Value load_value(const std::filesystem::path& path) {
  return naming(path, [&] { return ValueReader(BlockFile::open(path)).value(); });
}

ValueFileSummary summarize_value_file(const std::filesystem::path& path) {
  return naming(path, [&] {
    const BlockFileHeader h = read_block_file_header(path);
    if (h.type >= value_type_names.size()) throw DamagedFile("it holds a value of an unknown type");
    return ValueFileSummary{static_cast<ValueType>(h.type), h.digest, h.seconds};
  });
}

Size exemplar_of_index_file(const std::filesystem::path& path) {
  return naming(path, [&] { return ValueReader(BlockFile::open_contents(path)).exemplar_of_index(); });
}

}  // namespace terrazzo
