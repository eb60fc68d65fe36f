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
/// key are all made from it. Nodes are pure: their outputs depend on inputs, parameters and the files that
/// `files_read` names, and on nothing else.
namespace terrazzo {

/// Texts by name: {"r": "ambient_occlusion.r"}.
using TextMap = std::map<std::string, std::string>;
using Texts = std::vector<std::string>;

using ParamAlternatives = std::variant<bool, int64_t, double, std::string, Size, Numbers, Texts, NumberMap, TextMap>;

/// Alternatives are in the order of ParamType; choices and paths are texts. A structure, so that copying and destroying
/// nine alternatives is compiled once: it took a tenth of a node's compile time.
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

/// What "library:NAME" stands for as the value of a path: a part of a named analysis.
enum class LibraryFile : uint8_t {
  none,      ///< it is refused
  analysis,  ///< the file
  material,  ///< the folder of the analysed maps
  kept,      ///< itself: it goes on to the parameter of a node
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

/// Feeds parameters into a key: by name and value, independent of order and of how the document wrote them.
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

/// What becomes of a node's outputs.
enum class Persist : uint8_t {
  payload,  ///< slow: outputs are stored in the cache
  digest,   ///< fast: only the outputs' digests are stored; they are recomputed when a reader runs
  derived,  ///< lazy: outputs are computed on demand, named by the node's key, and never stored
};

/// A file that a sink will write.
struct FutureFile {
  std::string param;  ///< the parameter that says where
  std::filesystem::path folder;
  std::string name;    ///< empty if not known yet; the file is then in `folder`, or deeper
  std::string what{};  ///< its content, for messages
};

/// What is known of a value before it is there; what is empty is not known.
struct Forecast {
  std::vector<std::string> maps{};  ///< that a material certainly has
  /// Maps that it may also have; nullopt if not known.
  std::optional<std::vector<std::string>> possible_maps{};
  std::map<std::string, ImageFacts> images{};  ///< of maps by name, certain and possible ones; of an image under ""
  /// Pixels of a uv map; for features, appearance and index those of the exemplar.
  std::optional<Size> size{};
  int values = 0;                   ///< that features, appearance and index have at a pixel of the maps; 0: not known
  std::optional<Size> exemplar{};   ///< that a uv map was made for
  std::vector<FutureFile> files{};  ///< of a sink
};
/// By connected port, one for each wire.
using InputForecasts = std::map<std::string, std::vector<Forecast>>;
/// By output port; ports of which nothing is known may be left out.
using OutputForecasts = std::map<std::string, Forecast>;

/// All that there is to know of a value that is there.
Forecast forecast_of(const Value& value);
/// What is known of a value once it has come through a wire to a port of another type, see `converts`.
Forecast converted(const Forecast& forecast, ValueType from, ValueType to);
/// Empty unless the value may be what the forecast says; else what differs, such as `an image of 64x64 pixels and 1
/// channel, where an image of 3 channels was foreseen`.
std::string contradiction(const Forecast& forecast, const Value& value);

class NodeContext;

/// Where a node type comes from that is not terrazzo's own.
struct NodeOrigin {
  std::string name{};     ///< of the plug-in or program; empty: terrazzo
  std::string version{};  ///< as it says itself
  Digest content{};       ///< of what the code is in, as far as that is known
};

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
  std::function<void(NodeContext&)> compute;
  /// The files that the node reads; their content is part of the key. Missing files may be listed: the key then says
  /// "missing", and compute reports them.
  std::function<std::vector<std::filesystem::path>(const Params&)> files_read;
  /// Estimated bytes that compute needs besides its inputs, for the memory budget.
  std::function<size_t(const NodeContext&)> memory_hint;
  /// Bytes that compute takes at least, at its peak, as far as that is known before anything runs; else 0. A budget
  /// that is smaller is refused then.
  std::function<uint64_t(const Params&, const InputForecasts&)> memory_ahead;
  /// Checks of several parameters together; one message per problem, starting with the parameter's name in quotes.
  /// Called when a document is checked, before anything runs.
  std::function<std::vector<std::string>(const Params&)> check;
  /// The rule of shapes: what is known of the outputs, given the parameters and what is known of the inputs. Throws
  /// Error, or Errors, about the port or parameter for what certainly cannot work; what is not known is no mistake.
  /// Called while a document is checked and a plan is made, and once more right before compute with all that the inputs
  /// are, so that compute need not check them again. A pure function: reads no files; thread-safe.
  std::function<OutputForecasts(const Params&, const InputForecasts&)> infer;
  /// Runs while a plan is made, after `infer`, so that mistakes are found before hours of work: throws Error, or
  /// Errors, for what compute would refuse (such as a missing folder), and returns what else is certain: what is known
  /// of its material, or of its only output, and the files of a sink. Must be fast; may read files that `files_read`
  /// names.
  std::function<Forecast(const Params&, const InputForecasts&)> preflight;
  /// What is allowed and probably unintended, for the command `check`: one message each, starting with the name of a
  /// parameter or port in quotes if it is about one. May read files that `files_read` names; ports that are open are
  /// not there.
  std::function<std::vector<std::string>(const Params&, const InputForecasts&)> lint;
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

/// What compute works with: inputs, parameters and outputs. Not thread-safe, except for `task()`; a node may use many
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
  /// Something the user should know (what was recognised or ignored); printed, and stored with the result.
  void note(std::string message) { notes_.push_back(std::move(message)); }
  /// The same for likely mistakes and losses of quality; shown prominently.
  void warn(const std::string& message) { notes_.push_back(std::string(warning_mark) + message); }

  /// For sinks: a temporary name beside `target` to write to. Creates folders, and removes what killed runs left in
  /// them. The runner renames all staged files once compute has returned, and removes them and the folders if it
  /// throws.
  std::filesystem::path stage(const std::filesystem::path& target);

  // For the runner.
  /// Checks the inputs by the type's `infer`, and calls its compute.
  void compute();
  /// What `infer` said of the outputs in `compute`.
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
