#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/number_map.h"
#include "core/base/task.h"
#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "core/node/value.h"

/// The node interface. A node type is one descriptor; validation, the JSON schema, the printed reference and the cache
/// key are all derived from it. Nodes are pure: their outputs depend only on inputs, parameters and the files that
/// `files_read` names.
namespace terrazzo {

/// Texts by name: {"r": "ambient_occlusion.r"}.
using TextMap = std::map<std::string, std::string>;
using Texts = std::vector<std::string>;

using ParamAlternatives = std::variant<bool, int64_t, double, std::string, Size, Numbers, Texts, NumberMap, TextMap>;

/// Alternatives are in the order of ParamType; choices and paths are texts. A struct with out-of-line copy and
/// destructor: instantiating those of the variant in every file took a tenth of a node's compile time.
struct ParamValue : ParamAlternatives {
  using ParamAlternatives::ParamAlternatives;
  ParamValue(const ParamValue& other);
  ParamValue(ParamValue&& other) noexcept;
  ParamValue& operator=(const ParamValue& other);
  ParamValue& operator=(ParamValue&& other) noexcept;
  ~ParamValue();
};

enum class ParamType : uint8_t {
  boolean,
  integer,
  number,
  text,
  size,        ///< [width, height], or "512x512", or one number for a square
  numbers,     ///< a list of numbers
  texts,       ///< a list of texts
  number_map,  ///< numbers by name
  text_map,    ///< texts by name
  choice,      ///< one of `choices`
  path,        ///< a file or folder; made absolute before the node sees it
};
std::string_view name_of(ParamType type);

/// Which part of a named analysis "library:NAME" stands for as the value of a path.
enum class LibraryFile : uint8_t {
  none,      ///< such values are refused
  analysis,  ///< the file
  material,  ///< the folder of the analysed maps
  kept,      ///< the text itself, passed on to a node's parameter
};

struct Param {
  std::string name;
  ParamType type = ParamType::number;
  std::optional<ParamValue> fallback{};     ///< the default; a parameter without one must be given
  std::string help{};                       ///< one or two sentences
  std::optional<double> min{}, max{};       ///< for integer, number, and every element of size, numbers, number_map
  std::string unit{};                       ///< "pixels", "degrees", ... or empty
  std::vector<std::string> choices{};       ///< for choice; for number_map and text_map the allowed names, if not empty
  int min_count = 0, max_count = 0;         ///< for numbers and texts; 0 = no limit
  LibraryFile library = LibraryFile::none;  ///< for path
};

/// All of a node's parameters by name: defaults filled in, checked against the descriptor.
using Params = std::map<std::string, ParamValue>;

/// Feeds parameters into a key by name and value, independent of their order and spelling in the document.
void add_to(Hasher& hasher, const Params& params);

struct Port {
  std::string name;
  ValueType type = ValueType::image;
  std::string help{};
  bool optional = false;
  bool list = false;  ///< takes a list of wires
};

/// A step of a node's algorithm, for its reference.
struct NodeStep {
  std::string name;
  std::string when;  ///< phase, and conditions
  std::string help;  ///< what it does
};

/// How a node's outputs are cached.
enum class Persist : uint8_t {
  payload,  ///< slow: outputs are stored in the cache
  digest,   ///< fast: only the outputs' digests are stored; they are recomputed when a node that reads them runs
  derived,  ///< lazy: outputs are computed on demand, named by the node's key, and never stored
};

/// A file that a sink will write.
struct FutureFile {
  std::string param;  ///< the parameter that gives its location
  std::filesystem::path folder;
  std::string name;    ///< empty if not known yet: the file is then somewhere below `folder`
  std::string what{};  ///< its content, for messages
};

/// What is known of a value before it is computed. Empty members are unknown.
struct Forecast {
  std::vector<std::string> maps{};  ///< maps that a material certainly has
  /// Maps that it may also have; nullopt if unknown.
  std::optional<std::vector<std::string>> possible_maps{};
  std::map<std::string, ImageFacts> images{};  ///< of certain and possible maps by name; an image has the name ""
  /// The size of a uv map in pixels; for features, appearance and index that of the exemplar.
  std::optional<Size> size{};
  int values = 0;                   ///< channels per pixel of features, appearance and index; 0: unknown
  std::optional<Size> exemplar{};   ///< size of the exemplar that a uv map refers to
  std::vector<FutureFile> files{};  ///< that a sink will write
};
/// By connected port, one forecast per wire.
using InputForecasts = std::map<std::string, std::vector<Forecast>>;
/// By output port. Ports about which nothing is known may be left out.
using OutputForecasts = std::map<std::string, Forecast>;

/// Everything about a computed value.
Forecast forecast_of(const Value& value);
/// The forecast of a value after a wire has converted it to the type of an input port, see `converts`.
Forecast converted(const Forecast& forecast, ValueType from, ValueType to);
/// Empty if the value agrees with the forecast; else the difference, such as `an image of 64x64 pixels and 1 channel,
/// where an image of 3 channels was foreseen`.
std::string contradiction(const Forecast& forecast, const Value& value);

class NodeContext;

/// The plug-in or program that a node type comes from.
struct NodeOrigin {
  std::string name{};     ///< empty: terrazzo itself
  std::string version{};  ///< as the plug-in or program states it
  Digest content{};       ///< of the file that holds the code, if known
};

/// A warning about valid but probably unintended settings.
struct Lint {
  std::string message;        ///< starts with the parameter's or port's name in quotes if it is about one
  std::string answered_by{};  ///< a node type: if such a node reads this one, the warning is withheld
};
using Lints = std::vector<Lint>;

/// A node type: its interface and its hooks. Only `compute` is required.
///
/// | hook         | called                                                                    | may read files        |
/// |--------------|---------------------------------------------------------------------------|-----------------------|
/// | check        | while a document is read, once the node's parameters are known            | no                    |
/// | files_read   | while a plan is made, for the keys                                        | to find further files |
/// | infer        | while a plan is made, after the node's sources; again just before compute | no                    |
/// | preflight    | while a plan is made, right after infer                                   | those of files_read   |
/// | memory_ahead | while a plan is made, after preflight, if a budget is set                 | no                    |
/// | lint         | by the command `check`, once the graph is valid                           | those of files_read   |
/// | memory_hint  | during a run, once all inputs are computed, before the node may start     | headers of files_read |
/// | compute      | during a run, unless the results are cached                               | those of files_read   |
///
/// Expressions that ask for a node's results call infer and preflight earlier, while the document is read. Hooks must
/// be thread-safe and deterministic. Except for compute, they must be fast.
struct NodeType {
  std::string name;
  int version = 1;       ///< raise it whenever the same inputs would give other outputs
  std::string category;  ///< source, image, analysis, synthesis, sink
  std::string summary;   ///< one line
  std::string help{};    ///< what it does, when to use it, references for the method
  std::vector<Port> inputs;
  std::vector<Port> outputs;
  std::vector<Param> params;
  std::vector<NodeStep> steps{};  ///< in the order in which they run; empty for most nodes
  Persist persist = Persist::payload;
  /// Sets every output.
  std::function<void(NodeContext&)> compute;
  /// The files that the node reads; their content is part of the key. The list may include missing files: compute
  /// reports them.
  std::function<std::vector<std::filesystem::path>(const Params&)> files_read;
  /// An estimate of the bytes that compute needs besides its inputs, for the memory budget.
  std::function<size_t(const NodeContext&)> memory_hint;
  /// A lower bound for compute's peak memory in bytes; 0 if unknown. The plan refuses a smaller budget.
  std::function<uint64_t(const Params&, const InputForecasts&)> memory_ahead;
  /// Checks parameters against each other. One message per problem, starting with the parameter's name in quotes.
  std::function<std::vector<std::string>(const Params&)> check;
  /// What is known of the outputs, given the parameters and what is known of the inputs. Throws Error or Errors about
  /// the port or parameter for what is certain to fail; unknown facts are not errors. Just before compute all facts
  /// about the inputs are known, so compute need not check them again.
  std::function<OutputForecasts(const Params&, const InputForecasts&)> infer;
  /// Throws Error or Errors for what compute would refuse, such as a missing folder. Returns what else is known of the
  /// node's material, or of its first output if it has none, and the files that a sink will write.
  std::function<Forecast(const Params&, const InputForecasts&)> preflight;
  /// Unconnected ports are missing from the forecasts.
  std::function<Lints(const Params&, const InputForecasts&)> lint;
  NodeOrigin origin{};

  const Port* find_input(std::string_view port) const;
  const Port* find_output(std::string_view port) const;
  const Param* find_param(std::string_view param) const;
  /// Sinks write files and run even if nothing reads them.
  bool is_sink() const { return category == "sink"; }
};

/// A file that a sink has finished under a temporary name beside its target.
struct StagedFile {
  std::filesystem::path temporary;
  std::filesystem::path target;
};

/// The inputs, parameters and outputs of one call of compute. Not thread-safe, except for `task()`; a node may use many
/// threads internally.
class NodeContext {
 public:
  NodeContext(const NodeType& type, Params params, std::map<std::string, std::vector<Value>> inputs, Digest key,
              Task task);

  const NodeType& type() const { return type_; }
  const Task& task() const { return task_; }
  /// The stage's key: the recipe digest for lazily computed outputs (see Image::computed).
  const Digest& key() const { return key_; }

  /// A connected input of a required port.
  template <typename T>
  std::shared_ptr<const T> input(std::string_view port) const {
    return std::get<std::shared_ptr<const T>>(single(port));
  }
  /// Null if nothing is connected.
  template <typename T>
  std::shared_ptr<const T> optional_input(std::string_view port) const {
    const std::vector<Value>& v = values(port);
    return v.empty() ? nullptr : std::get<std::shared_ptr<const T>>(v.front());
  }
  /// All wires of a list port, in the document's order.
  template <typename T>
  std::vector<std::shared_ptr<const T>> list(std::string_view port) const {
    std::vector<std::shared_ptr<const T>> out;
    for (const Value& v : values(port)) out.push_back(std::get<std::shared_ptr<const T>>(v));
    return out;
  }

  const Params& params() const { return params_; }
  bool flag(std::string_view param) const { return get<bool>(param); }
  int64_t integer(std::string_view param) const { return get<int64_t>(param); }
  double number(std::string_view param) const { return get<double>(param); }
  const std::string& text(std::string_view param) const { return get<std::string>(param); }  ///< text, choice, path
  Size size(std::string_view param) const { return get<Size>(param); }
  const Numbers& numbers(std::string_view param) const { return get<Numbers>(param); }
  const Texts& texts(std::string_view param) const { return get<Texts>(param); }
  const NumberMap& number_map(std::string_view param) const { return get<NumberMap>(param); }
  const TextMap& text_map(std::string_view param) const { return get<TextMap>(param); }

  /// Every declared output must be set before compute returns.
  void output(std::string_view port, Value value);
  /// Tells the user something (what was recognised or ignored). Printed, and stored with the result.
  void note(std::string message) { notes_.push_back(std::move(message)); }
  /// The same for likely mistakes and losses of quality; shown prominently.
  void warn(const std::string& message) { notes_.push_back(std::string(warning_mark) + message); }

  /// For sinks: a temporary name beside `target` to write to. Creates folders and removes temporary files that killed
  /// runs left in them. The runner renames all staged files once compute has returned, and removes them and the folders
  /// if it throws.
  std::filesystem::path stage(const std::filesystem::path& target);

  // For the runner.
  /// Calls the type's `infer` to check the inputs, then its compute.
  void compute();
  /// The forecasts that `infer` returned in `compute`.
  const OutputForecasts& inferred() const { return inferred_; }
  std::map<std::string, Value>& outputs() { return outputs_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<StagedFile>& staged() const { return staged_; }
  /// The folders that `stage` has created, outer ones first.
  const std::vector<std::filesystem::path>& made_folders() const { return made_folders_; }

 private:
  const std::vector<Value>& values(std::string_view port) const;
  const Value& single(std::string_view port) const;
  template <typename T>
  const T& get(std::string_view param) const {
    return std::get<T>(value(param));
  }
  const ParamValue& value(std::string_view param) const;

  const NodeType& type_;
  Params params_;
  std::map<std::string, std::vector<Value>> inputs_;
  Digest key_;
  Task task_;
  OutputForecasts inferred_;
  std::map<std::string, Value> outputs_;
  std::vector<std::string> notes_;
  std::vector<StagedFile> staged_;
  std::vector<std::filesystem::path> made_folders_;
};

}  // namespace terrazzo
