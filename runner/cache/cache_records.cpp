#include "runner/cache/cache_records.h"

#include <string_view>

#include <xxhash.h>

#include "core/block_file/bytes.h"

namespace terrazzo {

namespace {

constexpr std::string_view stage_magic = "TZSTAGE1", memo_magic = "TZFILE_1", total_magic = "TZTOTAL1";

ByteWriter begun(std::string_view magic, const Digest& name) {
  ByteWriter out;
  out.append(magic.data(), magic.size());
  out.put(name);
  return out;
}

std::vector<uint8_t> sealed(ByteWriter out) {
  out.put(uint64_t{XXH3_64bits(out.bytes().data(), out.bytes().size())});
  return out.bytes();
}

/// The content of sealed bytes after magic and name.
ByteReader unsealed(std::string_view magic, const Digest& name, const std::vector<uint8_t>& bytes) {
  constexpr size_t seal = sizeof(uint64_t);
  if (bytes.size() < magic.size() + sizeof(Digest) + seal) throw DamagedFile("it ends too early");
  const size_t size = bytes.size() - seal;
  if (ByteReader(bytes.data() + size, seal).get<uint64_t>() != XXH3_64bits(bytes.data(), size))
    throw DamagedFile("its checksum is wrong");
  ByteReader in(bytes.data(), size);
  const auto* found = reinterpret_cast<const char*>(in.take(magic.size()));
  if (std::string_view(found, magic.size()) != magic) throw DamagedFile("it is of another format");
  if (in.get<Digest>() != name) throw DamagedFile("it is stored under another entry's name");
  return in;
}

}  // namespace

std::vector<uint8_t> stage_to_bytes(const Digest& key, const StageRecord& record) {
  ByteWriter out = begun(stage_magic, key);
  out.put(record.seconds);
  out.put(uint32_t(record.outputs.size()));
  for (const auto& [port, value] : record.outputs) {
    out.put_text(port);
    out.put(value);
  }
  out.put(uint32_t(record.notes.size()));
  for (const std::string& note : record.notes) out.put_text(note);
  out.put(uint32_t(record.files.size()));
  for (const OutputFile& f : record.files) {
    out.put_text(f.path.native());
    out.put(f.bytes);
    out.put(f.content);
  }
  return sealed(std::move(out));
}

StageRecord stage_from_bytes(const Digest& key, const std::vector<uint8_t>& bytes) {
  ByteReader in = unsealed(stage_magic, key, bytes);
  StageRecord record;
  record.seconds = in.get<double>();
  for (auto left = in.get<uint32_t>(); left > 0; left--) {
    std::string port = in.get_text();
    record.outputs[std::move(port)] = in.get<Digest>();
  }
  for (auto left = in.get<uint32_t>(); left > 0; left--) record.notes.push_back(in.get_text());
  for (auto left = in.get<uint32_t>(); left > 0; left--) {
    OutputFile f;
    f.path = in.get_text();
    f.bytes = in.get<uint64_t>();
    f.content = in.get<Digest>();
    record.files.push_back(std::move(f));
  }
  in.expect_end();
  return record;
}

std::vector<uint8_t> memo_to_bytes(const Digest& path, const FileMemo& memo) {
  ByteWriter out = begun(memo_magic, path);
  out.put(memo.stamp.bytes);
  out.put(memo.stamp.modified_ns);
  out.put(memo.stamp.changed_ns);
  out.put(memo.stamp.inode);
  out.put(memo.content);
  return sealed(std::move(out));
}

FileMemo memo_from_bytes(const Digest& path, const std::vector<uint8_t>& bytes) {
  ByteReader in = unsealed(memo_magic, path, bytes);
  FileMemo memo;
  memo.stamp.bytes = in.get<uint64_t>();
  memo.stamp.modified_ns = in.get<int64_t>();
  memo.stamp.changed_ns = in.get<int64_t>();
  memo.stamp.inode = in.get<uint64_t>();
  memo.content = in.get<Digest>();
  in.expect_end();
  return memo;
}

std::vector<uint8_t> total_to_bytes(const CacheTotal& total) {
  ByteWriter out = begun(total_magic, {});
  out.put(total.bytes);
  out.put(total.counted_ns);
  return sealed(std::move(out));
}

CacheTotal total_from_bytes(const std::vector<uint8_t>& bytes) {
  ByteReader in = unsealed(total_magic, {}, bytes);
  CacheTotal total;
  total.bytes = in.get<uint64_t>();
  total.counted_ns = in.get<int64_t>();
  in.expect_end();
  return total;
}

}  // namespace terrazzo
