#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

/// Format versions of graph documents: the number behind "terrazzo". Older documents are migrated when they are read.
namespace terrazzo {

/// Turns a document of one version into the next; the number itself is raised by the caller. Migrated values keep their
/// places, so that messages still point into the file.
using Migration = std::function<void(JsonValue& document)>;

/// Entry i turns version i + 1 into version i + 2; the current version is one more than their count.
const std::vector<Migration>& document_migrations();

/// Checks the version and brings the document up to date. False, with a problem added, if the version is missing, no
/// version, or newer than this program.
bool migrate(JsonValue& document, const std::vector<Migration>& migrations, std::vector<Problem>& problems);

/// The document in the current version. Throws GraphError, which names `file`, for syntax errors and unknown versions;
/// nothing else is checked.
JsonValue current_document(std::string_view text, const std::string& file,
                           const std::vector<Migration>& migrations = document_migrations());

/// The document in the current version and canonical form (see formatted). Throws GraphError, which names `file`, for
/// syntax errors and unknown versions; nothing else is checked.
std::string upgraded(std::string_view text, const std::string& file,
                     const std::vector<Migration>& migrations = document_migrations());

}  // namespace terrazzo
