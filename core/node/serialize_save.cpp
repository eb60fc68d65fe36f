#include <algorithm>

#include <tbb/parallel_for.h>

#include "core/block_file/block_file.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/node/serialize.h"

namespace terrazzo {

namespace {

uint64_t sample_count(const Image& image) {
  return uint64_t(image.size().area()) * uint64_t(image.channels());
}

struct CountSamples {
  uint64_t operator()(const ImagePtr& image) const { return sample_count(*image); }
  uint64_t operator()(const MaterialPtr& material) const {
    uint64_t sum = 0;
    for (const Map& m : material->maps()) sum += sample_count(*m.image);
    return sum;
  }
  uint64_t operator()(const FeaturesPtr& features) const {
    uint64_t sum = 0;
    for (const FeatureImage& f : features->images()) sum += sample_count(*f.image);
    if (features->mask()) sum += sample_count(*features->mask());
    return sum;
  }
  uint64_t operator()(const ReportPtr& report) const {
    uint64_t sum = 0;
    for (const Report::Picture& p : report->pictures()) sum += sample_count(*p.image);
    return sum;
  }
  template <typename T>
  uint64_t operator()(const std::shared_ptr<const T>&) const {
    return 0;
  }
};

/// Writes values to a block file: bulk data into streams, everything else into the description.
class ValueWriter {
 public:
  ValueWriter(BlockFileWriter& file, const Task& task, uint64_t samples)
      : file_(file), task_(task), samples_(std::max<uint64_t>(1, samples)) {}

  const std::vector<uint8_t>& description() const { return out_.bytes(); }

  void operator()(const ImagePtr& image) {
    const ImageInfo& info = image->info();
    put(info.size);
    out_.put(uint8_t(info.channels));
    out_.put(info.semantic);
    out_.put_text(info.color_space);
    out_.put(info.depth);
    out_.put(info.normal_y);
    out_.put(image->digest());
    out_.put(file_.begin_stream(StreamKind::samples));
    put_pixels(*image);
  }

  void operator()(const MaterialPtr& material) {
    out_.put_text(material->name());
    out_.put(uint32_t(material->maps().size()));
    for (const Map& m : material->maps()) {
      out_.put_text(m.name);
      (*this)(m.image);
    }
    out_.put(material->metres().width);
    out_.put(material->metres().height);
  }

  void operator()(const FeaturesPtr& features) {
    put(features->size());
    out_.put(uint8_t(features->wraps()));
    put(features->repeats());
    put(features->elements());
    out_.put(uint32_t(features->images().size()));
    for (const FeatureImage& f : features->images()) {
      (*this)(f.image);
      out_.put_text(f.map);
      for (const double w : f.weights) out_.put(w);
    }
    out_.put(uint8_t(features->mask() != nullptr));
    if (features->mask()) (*this)(features->mask());
  }

  void operator()(const AppearancePtr& appearance) {
    put(appearance->size());
    out_.put(int32_t(appearance->channels()));
    out_.put(uint8_t(appearance->wraps()));
    put(appearance->repeats());
    put(appearance->fingerprint());
    put(appearance->elements());
    out_.put(uint32_t(appearance->levels().size()));
    for (const AppearanceLevel& l : appearance->levels()) {
      put(l.size);
      out_.put(int32_t(l.dimensions));
      out_.put(l.scale);
      out_.put(l.retained);
      put_array(l.vectors);
      put_array(l.usable);
      put_array(l.mean);
      put_array(l.basis);
    }
  }

  void operator()(const IndexPtr& index) {
    (*this)(index->appearance());
    for (const SimilarSets& s : index->levels()) {
      out_.put(int32_t(s.per_pixel));
      put_array(s.positions);
    }
  }

  void operator()(const UvMapPtr& map) {
    put(map->size());
    put(map->exemplar());
    for (const bool wraps : {map->wraps().x, map->wraps().y, map->wraps().exemplar}) out_.put(uint8_t(wraps));
    put(map->fingerprint());
    put_array(map->pixels());
  }

  void operator()(const ReportPtr& report) {
    out_.put_text(report->title());
    out_.put(uint32_t(report->figures().size()));
    for (const Report::Figure& f : report->figures()) {
      out_.put_text(f.name);
      out_.put_text(f.help);
      out_.put(uint8_t(f.value.index()));
      if (const double* number = std::get_if<double>(&f.value))
        out_.put(*number);
      else
        out_.put_text(std::get<std::string>(f.value));
    }
    out_.put(uint32_t(report->pictures().size()));
    for (const Report::Picture& p : report->pictures()) {
      out_.put_text(p.name);
      (*this)(p.image);
    }
  }

 private:
  void put(const Lattice& lattice) {
    out_.put(uint8_t(lattice.rank));
    for (const double v :
         {lattice.first.x(), lattice.first.y(), lattice.second.x(), lattice.second.y(), lattice.certainty})
      out_.put(v);
  }

  void put(Vector2d v) {
    out_.put(v.x());
    out_.put(v.y());
  }

  void put(const Repeats& repeats) {
    put(repeats.lattice);
    for (const int v : {repeats.streaks.x, repeats.streaks.y}) out_.put(uint8_t(v));
    out_.put(uint8_t(repeats.parts.size()));
    for (const LatticePart& p : repeats.parts) {
      for (const int v : {p.place.x, p.place.y, p.place.width, p.place.height}) out_.put(int32_t(v));
      put(p.lattice);
      put(p.shown);
      put(p.start);
    }
  }

  void put(const FingerprintPtr& fingerprint) {
    out_.put(uint8_t(fingerprint != nullptr));
    if (!fingerprint) return;
    put(fingerprint->cells);
    out_.put(uint32_t(fingerprint->channels.size()));
    for (const Fingerprint::Channel& c : fingerprint->channels) {
      out_.put_text(c.map);
      out_.put(uint8_t(c.channel));
      put_array(c.means);
    }
  }

  void put(const ElementsPtr& elements) {
    out_.put(uint8_t(elements != nullptr));
    if (!elements) return;
    put(elements->size);
    out_.put(int32_t(elements->count));
    out_.put(elements->certainty);
    put_array(elements->at);
  }

  void put(Size size) {
    out_.put(int32_t(size.width));
    out_.put(int32_t(size.height));
  }

  template <typename T>
  void put_array(const std::vector<T>& items) {
    out_.put(file_.begin_stream(StreamKind::bytes));
    file_.add_bytes(reinterpret_cast<const uint8_t*>(items.data()), items.size() * sizeof(T));
  }

  void report_samples(uint64_t count) {
    written_ += count;
    task_.progress(double(written_) / double(samples_));
  }

  void put_pixels(const Image& image) {
    constexpr uint64_t step = 16 * samples_per_block;
    const uint64_t total = sample_count(image);
    if (const float* all = image.in_memory()) {
      for (uint64_t at = 0; at < total; at += step) {
        const uint64_t count = std::min(step, total - at);
        file_.add_samples(all + at, count);
        report_samples(count);
      }
      return;
    }
    const uint64_t row = uint64_t(image.width()) * uint64_t(image.channels());
    const int rows = int(std::max<uint64_t>(1, step / row));
    std::vector<float> pulled;  // rows that wait for the rest of their block, then the rows of this strip
    for (int y = 0; y < image.height(); y += rows) {
      const int here = std::min(rows, image.height() - y);
      const size_t waiting = pulled.size();
      pulled.resize(waiting + uint64_t(here) * row);
      pull(image, y, here, pulled.data() + waiting);
      const bool last = y + here == image.height();
      const uint64_t ready = last ? pulled.size() : pulled.size() / samples_per_block * samples_per_block;
      file_.add_samples(pulled.data(), ready);
      pulled.erase(pulled.begin(), pulled.begin() + ptrdiff_t(ready));
      report_samples(uint64_t(here) * row);
    }
  }

  void pull(const Image& image, int y, int rows, float* out) const {
    constexpr int rows_at_once = 32;
    const size_t row = size_t(image.width()) * size_t(image.channels());
    tbb::parallel_for(0, (rows + rows_at_once - 1) / rows_at_once, [&](int i) {
      const CurrentTask scope(task_);
      const int first = i * rows_at_once;
      image.read({0, y + first, image.width(), std::min(rows_at_once, rows - first)}, out + size_t(first) * row);
    });
  }

  BlockFileWriter& file_;
  const Task& task_;
  uint64_t samples_;
  uint64_t written_ = 0;
  ByteWriter out_;
};

}  // namespace

void save_value(const Value& value, const std::filesystem::path& path, const Task& task, double seconds, bool sync) {
  BlockFileWriter file(path, task);
  ValueWriter writer(file, task, std::visit(CountSamples(), value));
  std::visit(writer, value);
  file.finish({uint32_t(type_of(value)), digest_of(value), seconds}, writer.description(), sync);
}

}  // namespace terrazzo
