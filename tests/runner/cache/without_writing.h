#pragma once

#include <filesystem>

#include <doctest/doctest.h>
#include <unistd.h>

namespace terrazzo::test {

/// Takes away the permission to write to a folder. Who may write anywhere becomes nobody for as long as the object
/// lives.
class WithoutWriting {
 public:
  explicit WithoutWriting(const std::filesystem::path& folder) : folder_(folder) {
    if (root_)
      REQUIRE(::seteuid(65534) == 0);
    else
      permit(0555);
  }
  ~WithoutWriting() {
    if (root_)
      CHECK(::seteuid(0) == 0);
    else
      permit(0755);
  }

 private:
  void permit(int mode) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      if (entry.is_directory()) std::filesystem::permissions(entry.path(), std::filesystem::perms(mode));
  }
  std::filesystem::path folder_;
  bool root_ = ::geteuid() == 0;
};

}  // namespace terrazzo::test
