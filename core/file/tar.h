#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

/// Archives in the tar format of POSIX.1-2001 (ustar, with pax headers for long names): common tools can read them.
namespace terrazzo {

/// Writes an archive under a temporary name and removes it unless finish() is called. The same content gives the same
/// bytes: times and owners are left out. Throws FileError.
class TarWriter {
 public:
  explicit TarWriter(const std::filesystem::path& target);
  ~TarWriter();
  TarWriter(const TarWriter&) = delete;
  TarWriter& operator=(const TarWriter&) = delete;

  void add(const std::string& name, std::string_view bytes);
  void add_file(const std::string& name, const std::filesystem::path& file);
  /// Completes the archive and renames it to the target.
  void finish();

 private:
  void begin(const std::string& name, uint64_t bytes);
  void header(const std::string& name, uint64_t bytes, char type);
  void write(std::string_view bytes);
  void pad(uint64_t bytes);

  std::filesystem::path target_, temporary_;
  std::ofstream out_;
};

/// A regular file in an archive.
struct TarEntry {
  std::string name;
  uint64_t offset = 0;
  uint64_t bytes = 0;
};

/// Whether a file begins like an archive; false if it cannot be read.
bool is_tar(const std::filesystem::path& file);

/// The files in an archive. Throws Error if it is no archive, is truncated, has a wrong checksum, or contains anything
/// but regular files and folders.
std::vector<TarEntry> tar_entries(const std::filesystem::path& archive);

/// Writes an entry's bytes to `target`, whose folder must exist. Throws FileError, or Error if the archive has changed.
void extract(const std::filesystem::path& archive, const TarEntry& entry, const std::filesystem::path& target);

}  // namespace terrazzo
