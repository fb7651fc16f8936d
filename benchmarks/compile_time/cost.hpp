// Cost of a compiler process, measured by the operating system: processor time and memory of it and its children.
#pragma once

#include <string>
#include <vector>

struct Cost {
  double seconds = 0.0;    ///< processor time, user and system [s]
  double megabytes = 0.0;  ///< largest memory of one process [MB]
  long text = 0;           ///< bytes of code and constants in the object
  long lines = 0;          ///< lines after the preprocessor
};

using Command = std::vector<std::string>;

/// Runs a command, with its standard output written to `output` when not empty. Throws std::runtime_error when it
/// fails.
Cost run(const Command& command, const std::string& output = {});

/// Compiles a source into `object`; `lines` and `text` are set when `sizes` is true (two more processes).
Cost compile(const Command& compiler, const std::string& source, const std::string& object, bool sizes);

/// The median of each figure. Needs at least one cost.
Cost median(const std::vector<Cost>& costs);
