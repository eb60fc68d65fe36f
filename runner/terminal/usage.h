#pragma once

#include <cstdint>
#include <string>

#include "core/file/file_io.h"
#include "graphs/text/problem.h"

/// Exit codes, usage errors and sizes, shared by all commands.
namespace terrazzo {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;  ///< a node failed, or something could not be written
inline constexpr int exit_usage = 2;   ///< bad usage or an invalid graph
inline constexpr int exit_cancelled = 130;

/// An invalid command line; leads to exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Runs `act` and converts its errors to UsageError, except FileError and GraphError.
template <typename Act>
auto as_usage(const Act& act) {
  try {
    return act();
  } catch (const FileError&) {
    throw;
  } catch (const GraphError&) {
    throw;
  } catch (const Error& e) {
    throw UsageError(e.what());
  }
}

/// Throws UsageError, before the run, unless the option's file can be written. Accepts an empty `path`.
void check_writable(const char* option, const std::string& path);
/// Parses "512M", "2G", "1.5 GiB" into bytes. Throws UsageError.
uint64_t parse_bytes(const std::string& text, const std::string& option);
/// 1536 MiB as "1.5 GiB".
std::string shown_bytes(uint64_t bytes);

}  // namespace terrazzo
