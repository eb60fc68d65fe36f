#include <algorithm>
#include <cerrno>

#include <fmt/format.h>
#include <xxhash.h>
#include <zstd.h>

#include "core/block_file/block_file_format.h"

namespace terrazzo {

using namespace block_format;

uint64_t block_format::checksum(const void* data, size_t size) {
  return XXH3_64bits(data, size);
}

namespace {

/// Files up to this size are held in memory, so that many small values do not use up the file descriptors.
constexpr uint64_t held_bytes = uint64_t{1} << 20;

struct Header {
  BlockFileHeader header;
  uint64_t contents_offset = 0, contents_bytes = 0, contents_checksum = 0;
};

Header parse_header(const std::array<uint8_t, header_bytes>& bytes, size_t size) {
  if (size < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin()))
    throw DamagedFile("it is not a terrazzo value file, or was not written to its end");
  if (size < header_bytes) throw DamagedFile("it ends too early");
  ByteReader in(bytes.data() + magic.size(), bytes.size() - magic.size());
  const auto found = in.get<uint32_t>();
  if (found < version)
    throw OutdatedFile(fmt::format(
        "its format version is {}, and this terrazzo reads version {}: an older terrazzo wrote it", found, version));
  if (found > version)
    throw DamagedFile(fmt::format(
        "its format version is {}, and this terrazzo reads version {}: a newer terrazzo wrote it", found, version));
  Header h;
  h.header.type = in.get<uint32_t>();
  h.header.digest = in.get<Digest>();
  h.header.seconds = in.get<double>();
  h.contents_offset = in.get<uint64_t>();
  h.contents_bytes = in.get<uint64_t>();
  h.contents_checksum = in.get<uint64_t>();
  if (in.get<uint64_t>() != checksum(bytes.data(), header_bytes - sizeof(uint64_t)))
    throw DamagedFile("the checksum of its header is wrong");
  return h;
}

/// Throws Error unless the file is as long as its header says.
Header read_header(const File& file, const std::filesystem::path& path) {
  std::array<uint8_t, header_bytes> bytes{};
  const size_t read = file.read_at(0, bytes.data(), bytes.size(), path);
  const Header header = parse_header(bytes, read);
  const uint64_t size = file.size(path);
  if (header.contents_offset < header_bytes || header.contents_offset > size ||
      header.contents_bytes != size - header.contents_offset)
    throw DamagedFile(fmt::format("it has {} bytes, which is not what its header says", size));
  return header;
}

/// The uncompressed bytes of a block of `elements`.
uint64_t raw_size(StreamKind kind, SampleCoding coding, uint64_t elements) {
  return kind == StreamKind::bytes ? elements : elements * uint64_t(sample_bytes(coding));
}

}  // namespace

BlockFileHeader read_block_file_header(const std::filesystem::path& path) {
  return read_header(open_to_read(path), path).header;
}

void BlockFile::read_bytes(uint64_t offset, void* out, size_t size) const {
  if (file_.ok()) {
    if (file_.read_at(offset, out, size, path_) != size) throw DamagedFile("it ends too early");
    return;
  }
  if (offset > memory_.size() || size > memory_.size() - offset) throw DamagedFile("it ends too early");
  std::copy_n(memory_.begin() + ptrdiff_t(offset), size, static_cast<uint8_t*>(out));
}

void BlockFile::read_contents(uint64_t offset, uint64_t size, uint64_t expected) {
  std::vector<uint8_t> bytes(size);
  read_bytes(offset, bytes.data(), size);
  if (checksum(bytes.data(), bytes.size()) != expected) throw DamagedFile("the checksum of its contents is wrong");
  ByteReader in(bytes);
  const auto described = in.get<uint64_t>();
  if (described > in.left()) throw DamagedFile("it ends too early");
  const uint8_t* description = in.take(described);
  description_.assign(description, description + described);
  const auto count = in.get<uint32_t>();
  uint64_t at = header_bytes;
  for (uint32_t s = 0; s < count; s++) {
    BlockStream stream;
    stream.kind = static_cast<StreamKind>(in.get_below<uint8_t>(2));
    stream.elements = in.get<uint64_t>();
    const uint64_t step = block_elements(stream.kind);
    const uint64_t blocks = stream.elements / step + (stream.elements % step != 0);
    if (blocks > in.left() / block_entry_bytes) throw DamagedFile("it names more blocks than it has");
    stream.blocks.resize(blocks);
    for (uint64_t i = 0; i < blocks; i++) {
      StoredBlock& b = stream.blocks[i];
      b.raw_bytes = in.get<uint32_t>();
      b.stored_bytes = in.get<uint32_t>();
      b.coding = static_cast<SampleCoding>(in.get_below<uint8_t>(sample_coding_count));
      b.checksum = in.get<uint64_t>();
      b.offset = at;
      at += b.stored_bytes;
      const uint64_t elements = std::min(step, stream.elements - i * step);
      if (b.raw_bytes != raw_size(stream.kind, b.coding, elements) || b.stored_bytes > b.raw_bytes || at > offset)
        throw DamagedFile("a block has an impossible size");
    }
    streams_.push_back(std::move(stream));
  }
  in.expect_end();
  if (at != offset) throw DamagedFile("its blocks do not add up to its size");
}

void BlockFile::verify_block(const StoredBlock& block, std::vector<uint8_t>& stored) const {
  stored.resize(block.stored_bytes);
  read_bytes(block.offset, stored.data(), stored.size());
  if (checksum(stored.data(), stored.size()) != block.checksum)
    throw DamagedFile(fmt::format("the checksum of the block at byte {} is wrong", block.offset));
}

RawBlock BlockFile::read(const StoredBlock& block) const {
  std::vector<uint8_t> stored;
  verify_block(block, stored);
  if (block.stored_bytes == block.raw_bytes) return {block.coding, std::move(stored)};
  std::vector<uint8_t> raw(block.raw_bytes);
  if (ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size()) != raw.size())
    throw DamagedFile(fmt::format("the block at byte {} cannot be decompressed", block.offset));
  return {block.coding, std::move(raw)};
}

std::shared_ptr<const BlockFile> BlockFile::open_contents(const std::filesystem::path& path) {
  auto result = std::shared_ptr<BlockFile>(new BlockFile);
  result->path_ = path;
  File file = open_to_read(path);
  const Header header = read_header(file, path);
  const uint64_t size = file.size(path);
  if (size <= held_bytes) {
    result->memory_.resize(size);
    if (file.read_at(0, result->memory_.data(), size, path) != size) throw DamagedFile("it ends too early");
  } else {
    result->file_ = std::move(file);
  }
  result->header_ = header.header;
  result->read_contents(header.contents_offset, header.contents_bytes, header.contents_checksum);
  return result;
}

std::shared_ptr<const BlockFile> BlockFile::open(const std::filesystem::path& path) {
  std::shared_ptr<const BlockFile> result = open_contents(path);
  std::vector<uint8_t> buffer;
  for (const BlockStream& stream : result->streams_)
    for (const StoredBlock& block : stream.blocks) result->verify_block(block, buffer);
  return result;
}

}  // namespace terrazzo
