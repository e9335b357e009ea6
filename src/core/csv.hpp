#pragma once
/// Text files of columns, as spreadsheets, loggers and editors of all systems save them.

#include <string>
#include <vector>

namespace desert_sim {

/// The text with \n at the end of each line, be it \r\n (Windows) or \r (old Macs) in the file, and without a
/// byte-order mark. Throws ConfigError in the name of `source` for UTF-16 or other text with NUL bytes.
std::string plain_lines(const std::string& text, const std::string& source);

/// What separates the columns of a line: a tab or a semicolon if there is one, else a comma.
char separator_of(const std::string& line);

/// The fields of a line without blanks and double quotes around them. In a field that begins with a double
/// quote, separators are text up to the quote that ends it (RFC 4180; two quotes are one that does not). A
/// line that ends with a separator ends with an empty field.
std::vector<std::string> csv_fields(const std::string& line, char separator);

/// The text without blanks and double quotes around it.
std::string trimmed(const std::string& text);

/// A number that is all of `text`; false if it is none, or not finite. `decimal_comma`: it may be written
/// 7,2.
bool read_plain_number(const std::string& text, double& number, bool decimal_comma = false);

}  // namespace desert_sim
