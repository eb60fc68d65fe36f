#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Texts and the files that hold them.
namespace terrazzo::test {

bool contains(const std::string& text, const std::string& part);

/// The whole content of a file, of any kind; empty if it cannot be read.
std::string read_text(const std::filesystem::path& path);
void write_text(const std::filesystem::path& path, const std::string& text);
/// The same, but a file that is there is removed first: some file systems sync one that is rewritten, which takes long.
void replace_text(const std::filesystem::path& path, const std::string& text);

/// Names of all files and folders in a folder, sorted.
std::vector<std::string> listing(const std::filesystem::path& folder);

/// Checks what was said about `document` against the .txt file beside it, and that the table in `list` names it. With
/// TERRAZZO_UPDATE_GOLDEN set, writes that file first.
void check_golden_message(const std::filesystem::path& document, const std::string& found,
                          const std::filesystem::path& list);

}  // namespace terrazzo::test
