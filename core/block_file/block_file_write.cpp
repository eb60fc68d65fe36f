#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <sys/stat.h>
#include <tbb/parallel_for.h>
#include <unistd.h>
#include <zstd.h>

#include "core/block_file/block_file_format.h"

namespace terrazzo {

using namespace block_format;

namespace {

/// Blocks compressed in parallel before they are written.
constexpr uint64_t batch_blocks = 16;
constexpr int compression_level = 1;

struct CodedBlock {
  StoredBlock entry;
  std::vector<uint8_t> bytes;
};

CodedBlock coded(RawBlock raw) {
  CodedBlock result;
  result.entry.coding = raw.coding;
  result.entry.raw_bytes = uint32_t(raw.bytes.size());
  result.bytes.resize(ZSTD_compressBound(raw.bytes.size()));
  const size_t size =
      ZSTD_compress(result.bytes.data(), result.bytes.size(), raw.bytes.data(), raw.bytes.size(), compression_level);
  if (ZSTD_isError(size) || size >= raw.bytes.size())
    result.bytes = std::move(raw.bytes);
  else
    result.bytes.resize(size);
  result.entry.stored_bytes = uint32_t(result.bytes.size());
  result.entry.checksum = checksum(result.bytes.data(), result.bytes.size());
  return result;
}

}  // namespace

BlockFileWriter::BlockFileWriter(std::filesystem::path path, const Task& task)
    : path_(std::move(path)), task_(task), file_(File::open(path_, O_WRONLY | O_CREAT | O_TRUNC)), end_(header_bytes) {
  if (!file_.ok()) throw_system_error("write", path_, errno);
  struct stat status;
  regular_ = ::fstat(file_.descriptor(), &status) == 0 && S_ISREG(status.st_mode);
}

BlockFileWriter::~BlockFileWriter() {
  if (!finished_ && regular_) ::unlink(path_.c_str());
}

uint32_t BlockFileWriter::begin_stream(StreamKind kind) {
  streams_.push_back({kind, 0, {}});
  return uint32_t(streams_.size() - 1);
}

void BlockFileWriter::add_blocks(uint64_t count, const std::function<RawBlock(uint64_t, uint64_t)>& block) {
  BlockStream& stream = streams_.back();
  const uint64_t step = block_elements(stream.kind);
  const uint64_t blocks = (count + step - 1) / step;
  for (uint64_t first = 0; first < blocks; first += batch_blocks) {
    task_.check();
    std::vector<CodedBlock> batch(std::min(batch_blocks, blocks - first));
    tbb::parallel_for(size_t{0}, batch.size(), [&](size_t i) {
      const uint64_t at = (first + i) * step;
      batch[i] = coded(block(at, std::min(step, count - at)));
    });
    for (CodedBlock& b : batch) {
      file_.write_at(end_, b.bytes.data(), b.bytes.size(), path_);
      b.entry.offset = end_;
      end_ += b.bytes.size();
      stream.blocks.push_back(b.entry);
    }
  }
  stream.elements += count;
}

void BlockFileWriter::add_bytes(const uint8_t* bytes, uint64_t count) {
  add_blocks(count, [bytes](uint64_t at, uint64_t n) {
    return RawBlock{SampleCoding::u8_divided, std::vector<uint8_t>(bytes + at, bytes + at + n)};
  });
}

void BlockFileWriter::add_samples(const float* samples, uint64_t count) {
  add_blocks(count, [samples](uint64_t at, uint64_t n) {
    CodedSamples c = code_samples(samples + at, n);
    return RawBlock{c.coding, std::move(c.bytes)};
  });
}

void BlockFileWriter::finish(const BlockFileHeader& header, const std::vector<uint8_t>& description, bool sync) {
  ByteWriter contents;
  contents.put(uint64_t{description.size()});
  contents.append(description.data(), description.size());
  contents.put(uint32_t(streams_.size()));
  for (const BlockStream& s : streams_) {
    contents.put(s.kind);
    contents.put(s.elements);
    for (const StoredBlock& b : s.blocks) {
      contents.put(b.raw_bytes);
      contents.put(b.stored_bytes);
      contents.put(b.coding);
      contents.put(b.checksum);
    }
  }
  const std::vector<uint8_t>& bytes = contents.bytes();
  file_.write_at(end_, bytes.data(), bytes.size(), path_);

  ByteWriter head;
  head.append(magic.data(), magic.size());
  head.put(version);
  head.put(header.type);
  head.put(header.digest);
  head.put(header.seconds);
  head.put(end_);
  head.put(uint64_t{bytes.size()});
  head.put(checksum(bytes.data(), bytes.size()));
  head.put(checksum(head.bytes().data(), head.bytes().size()));
  file_.write_at(0, head.bytes().data(), head.bytes().size(), path_);
  if (sync)
    file_.sync_and_close(path_);
  else
    file_.close(path_);
  finished_ = true;
}

}  // namespace terrazzo
