// The only file that includes CLI11, whose templates take long to compile.
#include <algorithm>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include "core/base/suggest.h"
#include "runner/terminal/command.h"

namespace terrazzo {

namespace {

constexpr int any_number = -1;  // CLI11's constant

/// As CLI::IsMember, which does not suggest a name.
CLI::Validator one_of(const std::vector<std::string>& choices, bool ignores_case) {
  const auto problem = [choices, ignores_case](std::string& given) -> std::string {
    for (const std::string& c : choices)
      if (given == c || (ignores_case && CLI::detail::to_lower(given) == CLI::detail::to_lower(c)))
        return given = c, "";
    return fmt::format("expected {}, found {}{}", fmt::join(choices, ", "), given, did_you_mean(given, choices));
  };
  return CLI::Validator(problem, "{" + CLI::detail::join(choices, ",") + "}");
}

/// Of an option that was given too often, CLI11 says: "--out: At Most 1 required but received 2".
std::string in_plain_words(const std::string& message) {
  constexpr std::string_view too_often = ": At Most 1 required but received ";
  const size_t at = message.find(too_often);
  if (at == message.npos) return message;
  return fmt::format("{}: expected once, found {} times", message.substr(0, at), message.substr(at + too_often.size()));
}

/// By their places among the command's options.
using Related = std::map<int, const CLI::Option*>;

/// What an option needs and excludes. CLI11 sorts them by address, so that its help and its messages differ from run to
/// run.
struct Relations {
  Related needs{}, excludes{};
};

/// CLI11's help, with each option's relations.
class HelpFormatter : public CLI::Formatter {
 public:
  std::map<const CLI::Option*, Relations> relations;

  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text = Formatter::make_option_opts(option);
    const auto found = relations.find(option);
    if (found == relations.end()) return text;
    const auto append = [&](const char* what, const Related& others) {
      if (!others.empty()) text += fmt::format(" {}:", what);
      for (const auto& [place, other] : others) text += " " + other->get_name();
    };
    append("Needs", found->second.needs);
    append("Excludes", found->second.excludes);
    return text;
  }
};

/// A CLI11 parser built from commands.
class Parser {
 public:
  Parser(Command& program, const std::string& version) : app_(program.help, program.path), version_(version) {
    formatter_->column_width(32);
    app_.formatter(formatter_);
    add_to(app_, program);
    app_.require_subcommand(0, 1);  // further words belong to the command, even if they are a command's name too
  }

  ParsedWords parse(int argc, const char* const* argv) {
    using Request = ParsedWords::Request;
    ParsedWords out;
    try {
      app_.parse(argc, argv);
      finish(out);
      check_relations();
      if (!out.command->run) out = {Request::nothing_known, out.command, CLI::RequiredError("A command").what()};
      return out;
    } catch (const CLI::CallForVersion& e) {
      out = {Request::version, nullptr, e.what()};
    } catch (const CLI::Success& e) {
      std::ostringstream text;
      app_.exit(e, text, text);
      out = {Request::help, nullptr, text.str()};
    } catch (const CLI::ParseError& e) {
      out = {Request::nothing_known, nullptr, in_plain_words(e.what())};
    }
    finish(out);
    return out;
  }

 private:
  void add_to(CLI::App& app, Command& command) {
    commands_[&app] = &command;
    app.footer(command.footer);
    std::map<std::string, const CLI::Option*> by_name;
    std::vector<const CLI::Option*> added;
    for (CommandOption& option : command.options)
      if (CLI::Option* made = add_option(app, option)) {
        options_[made] = &option;
        by_name[option.long_name()] = made;
        added.push_back(made);
      }
    const auto place = [&](const CLI::Option* made) { return int(std::ranges::find(added, made) - added.begin()); };
    for (const CommandOption& option : command.options) {
      const auto own = [&] { return by_name.at(option.long_name()); };
      for (const std::string& name : option.excludes) {
        const CLI::Option* const other = by_name.at(name);
        formatter_->relations[own()].excludes[place(other)] = other;
        formatter_->relations[other].excludes[place(own())] = own();
      }
      for (const std::string& name : option.needs)
        formatter_->relations[own()].needs[place(by_name.at(name))] = by_name.at(name);
    }
    for (Command& sub : command.commands) add_to(*app.add_subcommand(sub.name(), sub.help), sub);
    if (!command.commands.empty()) app.require_subcommand(1);
  }

  /// Null for --help, which CLI11 adds itself.
  CLI::Option* add_option(CLI::App& app, const CommandOption& o) {
    CLI::Option* const made = std::visit(
        [&](auto target) -> CLI::Option* {
          using Target = decltype(target);
          if constexpr (std::is_same_v<Target, std::monostate>)
            return o.long_name() == "--help"      ? nullptr
                   : o.long_name() == "--version" ? app.set_version_flag(o.names, version_, o.help)
                                                  : app.add_option(o.names, o.help);
          else if constexpr (std::is_same_v<Target, bool*> || std::is_same_v<Target, std::string*>)
            return o.is_flag
                       ? app.add_flag(o.implied.empty() ? o.names : o.names + "{" + o.implied + "}", *target, o.help)
                       : app.add_option(o.names, *target, o.help);
          else
            return app.add_option(o.names, *target, o.help);
        },
        o.target);
    if (!made) return nullptr;
    if (o.value_name) made->type_name(*o.value_name);
    if (o.is_repeated) made->take_all()->expected(1);
    if (o.is_argument() && std::holds_alternative<std::vector<std::string>*>(o.target))
      made->expected(o.is_required ? 1 : 0, any_number);
    if (!o.choices.empty()) made->check(one_of(o.choices, o.ignores_case));
    if (o.limits) made->check(CLI::Range(o.limits->first, o.limits->second));
    if (o.is_not_negative) made->check(CLI::NonNegativeNumber);
    if (o.check) made->check(o.check);
    if (o.is_required) made->required();
    if (o.is_hidden) made->group("");
    return made;
  }

  /// Throws CLI11's errors for options that are given without what they need, or with what they exclude.
  void check_relations() const {
    for (const auto& app : named_commands())
      for (const CLI::Option* option : app->get_options()) {
        const auto found = formatter_->relations.find(option);
        if (option->count() == 0 || found == formatter_->relations.end()) continue;
        for (const auto& [place, other] : found->second.needs)
          if (other->count() == 0) throw CLI::RequiresError(option->get_name(), other->get_name());
        for (const auto& [place, other] : found->second.excludes)
          if (other->count() > 0) throw CLI::ExcludesError(option->get_name(), other->get_name());
      }
  }

  /// The program, the command, its command...
  std::vector<const CLI::App*> named_commands() const {
    std::vector<const CLI::App*> all = {&app_};
    while (!all.back()->get_subcommands().empty()) all.push_back(all.back()->get_subcommands().front());
    return all;
  }

  /// The named command, its options' values, and the remaining words.
  void finish(ParsedWords& out) const {
    const CLI::App* const named = named_commands().back();
    out.command = commands_.at(named);
    out.unknown = named->remaining();
    for (const auto& [made, option] : options_) option->given = made->results();
  }

  std::shared_ptr<HelpFormatter> formatter_ = std::make_shared<HelpFormatter>();
  CLI::App app_;
  std::string version_;
  std::map<const CLI::App*, Command*> commands_;
  std::map<const CLI::Option*, CommandOption*> options_;
};

}  // namespace

ParsedWords parse_words(Command& program, const std::string& version, int argc, const char* const* argv) {
  return Parser(program, version).parse(argc, argv);
}

}  // namespace terrazzo
