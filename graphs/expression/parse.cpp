#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "core/base/text.h"
#include "graphs/expression/operations.h"
#include "graphs/expression/tree.h"

namespace terrazzo::expression {

namespace {

constexpr size_t longest = 10000;  // bytes
constexpr int deepest = 60;        // parts within parts
constexpr int most_parts = 1000;   // evaluating a long sum recurses once per part

/// The binary operators by ascending precedence.
const std::array<std::vector<std::string_view>, 6> levels = {{
    {"||"},
    {"&&"},
    {"==", "!="},
    {"<=", ">=", "<", ">"},
    {"+", "-"},
    {"*", "/", "%"},
}};

class Parser {
 public:
  Parser(std::string_view text, std::map<std::string, size_t>& parameters, std::map<std::string, size_t>& nodes)
      : text_(text), parameters_(parameters), nodes_(nodes) {}

  NodePtr parse() {
    if (text_.size() > longest)
      throw ExpressionError(longest, fmt::format("expected an expression of at most {} bytes", longest));
    NodePtr out = choice();
    skip_space();
    if (at_ < text_.size()) {
      if (text_[at_] == '=') fail("a comparison is written ==");
      fail(fmt::format("expected an operator or the end, found {}", what_follows()));
    }
    return out;
  }

 private:
  struct Deeper {
    explicit Deeper(Parser& p) : parser(p) {
      if (++parser.depth_ > deepest) parser.fail(fmt::format("expected at most {} parts within one another", deepest));
    }
    ~Deeper() { parser.depth_--; }
    Parser& parser;
  };

  NodePtr keep(Node node) {
    if (++parts_ > most_parts) fail(fmt::format("expected an expression of at most {} parts", most_parts));
    return std::make_unique<const Node>(std::move(node));
  }

  [[noreturn]] void fail(const std::string& message) const { throw ExpressionError(at_, message); }

  std::string what_follows() const {
    if (at_ >= text_.size()) return "the end";
    size_t end = at_ + 1;
    if (is_word(text_[at_])) {
      while (end < text_.size() && is_word(text_[end])) end++;
    } else {
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0) == 0x80) end++;
    }
    return fmt::format("{}", text_.substr(at_, end - at_));
  }

  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) at_++;
  }
  bool accept(std::string_view token) {
    skip_space();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  void expect(std::string_view token, std::string_view why) {
    if (!accept(token)) fail(fmt::format("expected {} {}, found {}", token, why, what_follows()));
  }

  NodePtr choice() {
    const Deeper deeper(*this);
    NodePtr condition = binary(0);
    skip_space();
    const size_t offset = at_;
    if (!accept("?")) return condition;
    Node out{.kind = Node::Kind::choice, .offset = offset};
    out.parts.push_back(std::move(condition));
    out.parts.push_back(choice());
    expect(":", "and what holds otherwise");
    out.parts.push_back(choice());
    return keep(std::move(out));
  }

  NodePtr binary(size_t level) {
    if (level == levels.size()) return unary();
    NodePtr left = binary(level + 1);
    for (;;) {
      skip_space();
      const size_t offset = at_;
      const auto found = std::ranges::find_if(levels[level], [&](std::string_view op) { return accept(op); });
      if (found == levels[level].end()) return left;
      Node out{.kind = Node::Kind::binary, .offset = offset, .name = std::string(*found)};
      out.parts.push_back(std::move(left));
      out.parts.push_back(binary(level + 1));
      left = keep(std::move(out));
    }
  }

  NodePtr unary() {
    const Deeper deeper(*this);
    skip_space();
    const size_t offset = at_;
    for (const std::string_view op : {"-", "!"}) {
      if (!accept(op)) continue;
      Node out{.kind = Node::Kind::unary, .offset = offset, .name = std::string(op)};
      out.parts.push_back(unary());
      return keep(std::move(out));
    }
    return members(primary());
  }

  NodePtr members(NodePtr of) {
    while (accept(".")) {
      const size_t offset = at_;
      Node out{.kind = Node::Kind::member, .offset = offset, .member = word("a name such as x or y after the dot")};
      out.parts.push_back(std::move(of));
      of = keep(std::move(out));
    }
    return of;
  }

  NodePtr primary() {
    skip_space();
    const size_t offset = at_;
    if (accept("(")) {
      NodePtr out = choice();
      expect(")", "to close (");
      return out;
    }
    if (accept("[")) return several({.kind = Node::Kind::list, .offset = offset}, "]");
    if (accept("@")) return fact(offset);
    if (accept("$")) {
      at_ = offset;
      fail(fmt::format("parameter names have no $ here: {}", text_.substr(offset + 1, 40)));
    }
    if (accept("'")) return text(offset);
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    const std::string name = word("a number, a name, 'text' or (");
    if (name == "true" || name == "false")
      return keep(Node{.kind = Node::Kind::constant, .offset = offset, .value = ParamValue(name == "true")});
    if (accept("(")) {
      if (const std::string wrong = unknown_function(name); !wrong.empty()) throw ExpressionError(offset, wrong);
      return several({.kind = Node::Kind::call, .offset = offset, .name = name}, ")");
    }
    parameters_.emplace(name, offset);
    return keep(Node{.kind = Node::Kind::parameter, .offset = offset, .name = name});
  }

  NodePtr several(Node out, std::string_view end) {
    if (!accept(end)) {
      do {
        out.parts.push_back(choice());
      } while (accept(","));
      expect(end, "or a comma");
    }
    return keep(std::move(out));
  }

  /// @node.size, @node.MAP.size, @node.count, @node.maps
  NodePtr fact(size_t offset) {
    Node out{.kind = Node::Kind::fact, .offset = offset};
    const size_t begin = at_;
    while (at_ < text_.size() && (is_word(text_[at_]) || text_[at_] == '-')) at_++;
    out.name = std::string(text_.substr(begin, at_ - begin));
    if (out.name.empty()) fail("expected a node's name after @");
    if (!accept(".")) fail(fmt::format("expected .size, .MAP.size, .count or .maps after @{}", out.name));
    out.member = word("size, a map's name, count or maps after the dot");
    if (out.member != "size" && out.member != "count" && out.member != "maps") {
      out.detail = out.member;
      if (!accept(".")) fail(fmt::format("expected .size after @{}.{}", out.name, out.detail));
      const size_t member = at_;
      out.member = word("size");
      if (out.member != "size")
        throw ExpressionError(member,
                              fmt::format("of a map only the size is known before it is made, found {}", out.member));
    }
    nodes_.emplace(out.name, offset);
    return keep(std::move(out));
  }

  NodePtr text(size_t offset) {
    const size_t end = text_.find('\'', at_);
    if (end == std::string_view::npos) throw ExpressionError(offset, "expected ' at the end of the text");
    std::string value(text_.substr(at_, end - at_));
    at_ = end + 1;
    return keep(Node{.kind = Node::Kind::constant, .offset = offset, .value = ParamValue(std::move(value))});
  }

  NodePtr number() {
    const size_t offset = at_;
    const char* const begin = text_.data() + at_;
    const char* const end = text_.data() + text_.size();
    double number = 0;
    int64_t whole = 0;
    const auto as_number = std::from_chars(begin, end, number);
    const auto as_whole = std::from_chars(begin, end, whole);
    if (as_number.ec != std::errc()) fail(fmt::format("expected a number, found {}", what_follows()));
    at_ += static_cast<size_t>(as_number.ptr - begin);
    if (at_ < text_.size() && is_word(text_[at_])) {
      at_ = offset;
      fail("expected an operator after the number; a unit is not written");
    }
    const bool is_whole = as_whole.ec == std::errc() && as_whole.ptr == as_number.ptr;
    return keep(Node{
        .kind = Node::Kind::constant, .offset = offset, .value = is_whole ? ParamValue(whole) : ParamValue(number)});
  }

  std::string word(std::string_view expected) {
    skip_space();
    const size_t begin = at_;
    if (at_ < text_.size() && is_letter(text_[at_]))
      while (at_ < text_.size() && is_word(text_[at_])) at_++;
    if (begin == at_) fail(fmt::format("expected {}, found {}", expected, what_follows()));
    return std::string(text_.substr(begin, at_ - begin));
  }

  const std::string_view text_;
  std::map<std::string, size_t>& parameters_;
  std::map<std::string, size_t>& nodes_;
  size_t at_ = 0;
  int depth_ = 0;
  int parts_ = 0;
};

}  // namespace

NodePtr parse(std::string_view text, std::map<std::string, size_t>& parameters, std::map<std::string, size_t>& nodes) {
  return Parser(text, parameters, nodes).parse();
}

}  // namespace terrazzo::expression
