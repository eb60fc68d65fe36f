#include "runner/editor/previews/picture_store.h"

#include "core/base/hash.h"

namespace terrazzo {

namespace {

/// Images hold what they are computed from.
constexpr size_t most_images = 24;

}  // namespace

PictureStore::PictureStore(size_t most_bytes) : most_bytes_(most_bytes) {}

std::string PictureStore::add(PictureFile file) {
  return add(std::move(file), nullptr);
}

std::string PictureStore::add(PictureFile file, const ImagePtr& image) {
  std::string digest = Hasher().add(file.type).bytes(file.bytes.data(), file.bytes.size()).digest().hex();
  const std::lock_guard lock(mutex_);
  const auto [at, is_new] = entries_.try_emplace(digest);
  Entry& entry = at->second;
  if (is_new) {
    bytes_ += file.bytes.size();
    entry.file = std::make_shared<const PictureFile>(std::move(file));
    entry.place = used_.insert(used_.begin(), digest);
  } else {
    used_.splice(used_.begin(), used_, entry.place);
  }
  if (image) {
    entry.image = image;
    images_.remove(digest);
    images_.push_front(digest);
  }
  make_room();
  return digest;
}

void PictureStore::make_room() {
  while (images_.size() > most_images) {
    entries_.at(images_.back()).image = nullptr;
    images_.pop_back();
  }
  while (bytes_ > most_bytes_ && used_.size() > 1) {
    const auto at = entries_.find(used_.back());
    bytes_ -= at->second.file->bytes.size();
    images_.remove(at->first);
    entries_.erase(at);
    used_.pop_back();
  }
}

PictureStore::FilePtr PictureStore::find(const std::string& digest) {
  const std::lock_guard lock(mutex_);
  const auto at = entries_.find(digest);
  if (at == entries_.end()) return nullptr;
  used_.splice(used_.begin(), used_, at->second.place);
  return at->second.file;
}

ImagePtr PictureStore::image(const std::string& digest) {
  const std::lock_guard lock(mutex_);
  const auto at = entries_.find(digest);
  return at == entries_.end() ? nullptr : at->second.image;
}

}  // namespace terrazzo
