// What a compiler's process costs, measured by the system: processor time and memory of it and its children.
#pragma once

#include <string>
#include <vector>

struct Cost {
  double seconds = 0.0;    ///< processor time, user and system
  double megabytes = 0.0;  ///< largest memory of one process
  long text = 0;           ///< bytes of code and constants in the object
  long lines = 0;          ///< after the preprocessor
};

using Command = std::vector<std::string>;

/// Runs a command, its standard output into a file when one is named. Throws std::runtime_error when it fails.
Cost run(const Command& command, const std::string& output = {});

/// Compiles a source into `object`; `lines` and `text` are filled in when `sizes` is true (two more processes).
Cost compile(const Command& compiler, const std::string& source, const std::string& object, bool sizes);

/// The middle one of each figure. Needs at least one.
Cost median(const std::vector<Cost>& costs);
