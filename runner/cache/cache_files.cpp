#include <cerrno>
#include <optional>

#include <fcntl.h>
#include <fmt/format.h>

#include "core/block_file/bytes.h"
#include "core/file/file_io.h"
#include "runner/cache/cache.h"
#include "runner/cache/cache_records.h"
#include "runner/cache/cache_state.h"

namespace terrazzo {

namespace {

Digest missing_digest() {
  return Hasher().add("missing file").digest();
}

}  // namespace

Digest file_content_digest(const std::filesystem::path& path) {
  const File file = File::open(path, O_RDONLY | O_NONBLOCK);
  if (!stamp_of(file)) return missing_digest();
  return content_digest(file, path).value_or(missing_digest());
}

Digest Cache::file_digest(const std::filesystem::path& path) {
  const std::filesystem::path absolute = std::filesystem::absolute(path).lexically_normal();
  const Digest name = Hasher().add(absolute.native()).digest();
  const std::filesystem::path memo_path = state_->folder.path_of(EntryKind::file, name);
  try {
    const auto bytes = CacheFolder::read_and_use(memo_path);
    if (bytes) {
      const FileMemo memo = memo_from_bytes(name, *bytes);
      if (stamp_of(absolute) == memo.stamp) return memo.content;
    }
  } catch (const Error&) {
    // An unusable memo is rewritten.
  }
  const File file = File::open(absolute, O_RDONLY | O_NONBLOCK);
  const std::optional<FileStamp> before = stamp_of(file);
  if (!before) return missing_digest();
  const int64_t begun = now_ns();
  const std::optional<Digest> content = content_digest(file, absolute);
  if (!content) return missing_digest();
  if (before->is_settled(begun) && stamp_of(file) == before) {
    try {
      state_->folder.write(memo_path, memo_to_bytes(name, {*before, *content}), state_->pins.owner(), false);
    } catch (const Error& e) {
      state_->warn_unwritten(e);
    }
  }
  return *content;
}

}  // namespace terrazzo
