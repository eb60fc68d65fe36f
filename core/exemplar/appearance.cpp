#include "core/exemplar/appearance.h"

#include <algorithm>
#include <stdexcept>

namespace terrazzo {

AppearancePtr Appearance::make(std::vector<AppearanceLevel> levels, int channels, bool wraps, const Repeats& repeats,
                               FingerprintPtr fingerprint, ElementsPtr elements, Size exemplar) {
  if (exemplar.area() == 0) exemplar = levels.front().size;
  Hasher h;
  h.add("appearance").add(channels).add(wraps).add(int64_t(levels.size()));
  repeats.add_to(h);
  if (fingerprint) fingerprint->add_to(h);
  if (repeats.streaks.shortened(exemplar) != levels.front().size)
    throw std::logic_error("the finest level needs the exemplar's size, along streaks as much shortened as they are");
  if (repeats.streaks.any()) h.add(exemplar.width).add(exemplar.height);
  if (elements && elements->size != exemplar) throw std::logic_error("elements need the exemplar's size");
  if (elements) elements->add_to(h.add("elements"));
  for (const AppearanceLevel& l : levels) {
    if (l.vectors.size() != size_t(l.size.area())) throw std::logic_error("one appearance vector per pixel");
    if (!l.usable.empty() && l.usable.size() != l.vectors.size())
      throw std::logic_error("usable needs one entry per pixel");
    if (!l.usable.empty() && std::find(l.usable.begin(), l.usable.end(), 1) == l.usable.end())
      throw std::logic_error("a level without a usable pixel");
    h.add(l.size.width).add(l.size.height).add(l.dimensions).add(l.scale);
    h.bytes(l.vectors.data(), l.vectors.size() * sizeof(AppearanceVector));
    h.bytes(l.usable.data(), l.usable.size());
    h.bytes(l.mean.data(), l.mean.size() * sizeof(float));
    h.bytes(l.basis.data(), l.basis.size() * sizeof(float));
  }
  auto a = std::shared_ptr<Appearance>(new Appearance);
  a->size_ = exemplar;
  a->levels_ = std::move(levels);
  a->channels_ = channels;
  a->wraps_ = wraps;
  a->repeats_ = repeats;
  a->fingerprint_ = std::move(fingerprint);
  a->elements_ = std::move(elements);
  a->digest_ = h.digest();
  return a;
}

IndexPtr Index::make(AppearancePtr appearance, std::vector<SimilarSets> levels) {
  if (levels.size() != appearance->levels().size()) throw std::logic_error("one set of similar pixels per level");
  Hasher h;
  h.add("index").add(appearance->digest()).add(int64_t(levels.size()));
  for (const SimilarSets& s : levels) {
    h.add(s.per_pixel);
    h.bytes(s.positions.data(), s.positions.size() * sizeof(uint32_t));
  }
  auto index = std::shared_ptr<Index>(new Index);
  index->appearance_ = std::move(appearance);
  index->levels_ = std::move(levels);
  index->digest_ = h.digest();
  return index;
}

}  // namespace terrazzo
