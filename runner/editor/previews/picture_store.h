#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "core/image/image.h"
#include "runner/report/pictures.h"

namespace terrazzo {

/// The pictures that pages may ask for, by digest: those that a run has made known. Bounded; the pictures used longest
/// ago go first. Thread-safe.
class PictureStore {
 public:
  explicit PictureStore(size_t most_bytes = 256 << 20);

  using FilePtr = std::shared_ptr<const PictureFile>;
  /// Adds a file and returns its digest in hexadecimal digits.
  std::string add(PictureFile file);
  /// The same for the picture of an image whose exact values may be asked for.
  std::string add(PictureFile file, const ImagePtr& image);

  /// Null if it is not known (any more). `digest` may be any text.
  FilePtr find(const std::string& digest);
  ImagePtr image(const std::string& digest);

 private:
  struct Entry {
    FilePtr file;
    ImagePtr image;
    std::list<std::string>::iterator place;
  };
  void make_room();

  const size_t most_bytes_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  std::list<std::string> used_;    // most recently used first
  std::list<std::string> images_;  // entries that hold an image, newest first
  size_t bytes_ = 0;
};

}  // namespace terrazzo
