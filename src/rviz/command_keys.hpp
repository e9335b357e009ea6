#pragma once
/// The keys of the commands that a timeline takes, for those who type them.

#include <QString>
#include <QStringList>
#include <string>

namespace desert_sim {

QStringList timed_commands();

struct CommandKeys {
  QString names;  ///< separated by commas
  QString tip;    ///< one line a key: what it is and what is allowed
};
/// `command`: one of timed_commands().
CommandKeys keys_of(const std::string& command);

}  // namespace desert_sim
