#!/usr/bin/env bash
# cpp-httplib's settings, macros of one's own before its header, do nothing in Debian's package.
#
# Version:   libcpp-httplib-dev 0.11.4+ds-1+deb12u1 (Debian 12)
# Guess:     as its README says of a library that is one header: #define CPPHTTPLIB_KEEPALIVE_MAX_COUNT 100 in front of it
#            makes servers keep connections for 100 requests.
# Behaviour: Debian splits the header: what uses the macros is compiled into a shared library, with the defaults. The
#            program's own code sees 100, the server says and does 5, without a word. Calls (set_keep_alive_max_count)
#            work.
# Matters:   a viewer that loads 40 tiles connects eight times, and limits that are set so (of payloads, of header
#            lengths, of threads) are not there. What has no call, such as the backlog of listen(), cannot be set.
# Seen on 2026-11-28:
#   the macro in the program: 100
#   the server, with the macro: timeout=5, max=5
#   the server, after the call: timeout=5, max=100
. "$(dirname "$0")/common/packages.bash"
debian libcpp-httplib-dev=0.11.4+ds-1+deb12u1
command -v g++ >/dev/null || skip "no g++"

cat >server.cpp <<'END'
#define CPPHTTPLIB_OPENSSL_SUPPORT
#define CPPHTTPLIB_KEEPALIVE_MAX_COUNT 100
#include <httplib.h>
#include <cstdio>
#include <thread>

static void tell(bool call) {
  httplib::Server server;
  if (call) server.set_keep_alive_max_count(100);
  server.Get("/", [](const httplib::Request&, httplib::Response& response) { response.set_content("x", "text/plain"); });
  const int port = server.bind_to_any_port("127.0.0.1");
  std::thread listener([&] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();
  httplib::Client client("127.0.0.1", port);
  client.set_keep_alive(true);
  const auto answer = client.Get("/");
  std::puts(answer ? answer->get_header_value("Keep-Alive").c_str() : "no answer");
  client.stop();
  server.stop();
  listener.join();
}

int main() {
  std::printf("%d\n", CPPHTTPLIB_KEEPALIVE_MAX_COUNT);
  tell(false);
  tell(true);
}
END
library=$(find "$dir/root" /usr/lib -name 'libcpp-httplib.so' 2>/dev/null | head -n 1)
g++ -std=c++17 -O0 -I"$dir/root/usr/include" server.cpp -o server -L"$(dirname "$library")" -lcpp-httplib -lssl -lcrypto -lz \
  -lbrotlienc -lbrotlidec -pthread >build.log 2>&1 || { cat build.log; skip "the server does not build"; }
mapfile -t seen < <(./server)
expect "the macro in the program" "${seen[0]-}" "100"
expect "the server, with the macro" "${seen[1]-}" "timeout=5, max=5"
expect "the server, after the call" "${seen[2]-}" "timeout=5, max=100"
finish
