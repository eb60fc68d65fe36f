#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

/// Format versions of graph documents: the value of the key "terrazzo". Older documents are migrated when they are
/// read.
namespace terrazzo {

/// Converts a document to the next version; the caller increments the version number. Migrated values keep their
/// places, so that messages still point into the file.
using Migration = std::function<void(JsonValue& document)>;

/// Entry i converts version i + 1 to version i + 2. The current version is one more than their count.
const std::vector<Migration>& document_migrations();

/// Checks the version and migrates the document to the current one. Returns false, and adds a problem, if the version
/// is missing, invalid, or newer than this program.
bool migrate(JsonValue& document, const std::vector<Migration>& migrations, std::vector<Problem>& problems);

/// The document in the current version. Throws GraphError, which names `file`, for syntax errors and unknown versions;
/// checks nothing else.
JsonValue current_document(std::string_view text, const std::string& file,
                           const std::vector<Migration>& migrations = document_migrations());

/// The document in the current version and canonical form (see formatted). Throws GraphError, which names `file`, for
/// syntax errors and unknown versions; nothing else is checked.
std::string upgraded(std::string_view text, const std::string& file,
                     const std::vector<Migration>& migrations = document_migrations());

}  // namespace terrazzo
