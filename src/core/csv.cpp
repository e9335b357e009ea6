#include "src/core/csv.hpp"

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

#include "src/core/error.hpp"

namespace desert_sim {

std::string plain_lines(const std::string& text, const std::string& source) {
  const bool utf16 = text.compare(0, 2, "\xFF\xFE") == 0 || text.compare(0, 2, "\xFE\xFF") == 0;
  if (utf16 || text.find('\0') != std::string::npos)
    throw ConfigError(source +
                      (utf16 ? ": is UTF-16 text" : ": has NUL bytes, as UTF-16 text or a binary file") +
                      "; save it as UTF-8 or ASCII (\"CSV UTF-8\" in a spreadsheet)");
  std::string lines = text.compare(0, 3, "\xEF\xBB\xBF") == 0 ? text.substr(3) : text;
  std::size_t to = 0;
  for (std::size_t at = 0; at < lines.size(); ++at) {
    if (lines[at] == '\r' && at + 1 < lines.size() && lines[at + 1] == '\n') continue;
    lines[to++] = lines[at] == '\r' ? '\n' : lines[at];
  }
  lines.resize(to);
  return lines;
}

char separator_of(const std::string& line) {
  for (char separator : {'\t', ';'})
    if (line.find(separator) != std::string::npos) return separator;
  return ',';
}

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\"";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::vector<std::string> csv_fields(const std::string& line, char separator) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t at = 0; at < line.size(); ++at) {
    std::string& field = fields.back();
    if (line[at] == '"' && (quoted || field.find_first_not_of(" \t") == std::string::npos)) {
      quoted = !quoted;
      if (!quoted && at + 1 < line.size() && line[at + 1] == '"') {
        field += '"';
        quoted = true;
        ++at;
      }
    } else if (line[at] == separator && !quoted) {
      fields.emplace_back();
    } else {
      field += line[at];
    }
  }
  for (std::string& field : fields) field = trimmed(field);
  return fields;
}

bool read_plain_number(const std::string& text, double& number, bool decimal_comma) {
  std::string point = text;
  if (decimal_comma) std::replace(point.begin(), point.end(), ',', '.');
  std::istringstream in(point);
  in.imbue(std::locale::classic());
  std::string more;
  double read = 0;
  if (!(in >> read) || (in >> more) || !std::isfinite(read)) return false;
  number = read;
  return true;
}

}  // namespace desert_sim
