#include "runner/editor/http.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/file/module_path.h"

namespace terrazzo {

namespace {

const HttpLibrary& load_http_library() {
  const std::filesystem::path path = module_path("terrazzo_http.so", "the module for `terrazzo edit`");
  void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = module ? ::dlsym(module, "terrazzo_http_library") : nullptr;
  if (!symbol) throw Error(fmt::format("cannot load {}: {}", path.string(), ::dlerror()));
  return *reinterpret_cast<const HttpLibrary* (*)()>(symbol)();
}

const HttpLibrary& http_library() {
  static const HttpLibrary& library = load_http_library();
  return library;
}

}  // namespace

std::optional<std::string> HttpRequest::header(const std::string& name) const {
  const auto [first, last] = headers.equal_range(name);
  return first != last && std::next(first) == last ? std::optional(first->second) : std::nullopt;
}

std::string HttpRequest::queried(const std::string& name) const {
  const auto at = query.find(name);
  return at == query.end() ? "" : at->second;
}

std::unique_ptr<HttpServer> serve_http(int port, HttpHandler& handler, const HttpLimits& limits) {
  return http_library().serve(port, handler, limits);
}

}  // namespace terrazzo
