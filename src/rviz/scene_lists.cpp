#include "src/rviz/scene_lists.hpp"

#include <ros/package.h>
#include <ros/param.h>

#include <QDir>
#include <QDirIterator>
#include <cstdlib>

#include "src/scenario/scenario_names.hpp"

namespace desert_sim {

namespace {

constexpr int most_names = 500;  // of a kind: more are no help in a list

/// As the node takes an empty ~data_dir.
QString default_data_dir() {
  const char* const ros_home = std::getenv("ROS_HOME");
  return (ros_home && *ros_home ? QString(ros_home) : QDir::homePath() + "/.ros") + "/desert_sim";
}

/// The names of the YAML files in a folder of config/.
QStringList installed(const QString& folder) {
  QStringList names;
  const QString package = QString::fromStdString(ros::package::getPath("desert_sim"));
  if (package.isEmpty()) return names;
  for (const QFileInfo& file :
       QDir(package + "/config/" + folder).entryInfoList({"*.yaml"}, QDir::Files, QDir::Name))
    names << file.completeBaseName();
  return names;
}

}  // namespace

void name_apart(SceneLists& lists) {
  for (QString& name : lists.installed) {
    const int saved = lists.scenarios.indexOf(name);
    if (saved < 0) continue;
    lists.scenarios[saved] += QString("/") + saved_scenario_file;
    name = QString::fromStdString(installed_scenario_uri(name.toStdString()));
  }
}

SceneLists list_folder(const std::string& data_dir) {
  const QDir root(QString::fromStdString(data_dir));
  SceneLists lists;
  QDirIterator files(root.path(), {"*.yaml", "*.yml", "*.bag", "*.ckpt"}, QDir::Files,
                     QDirIterator::Subdirectories);
  while (files.hasNext()) {
    const QString name = root.relativeFilePath(files.next());
    const QFileInfo file(name);
    if (file.fileName() == "terrain.yaml" && file.path() != ".") lists.terrains << file.path();
    const bool whole = file.fileName() == saved_scenario_file && file.path() != ".";
    if (file.suffix() == "yaml" || file.suffix() == "yml") lists.scenarios << (whole ? file.path() : name);
    if (file.suffix() == "bag") lists.terrains << name;
    if (file.suffix() == "ckpt" && !file.fileName().startsWith("state-")) lists.checkpoints << name;
  }
  for (QStringList* const names : {&lists.scenarios, &lists.terrains, &lists.checkpoints}) {
    names->sort();
    *names = names->mid(0, most_names);
  }
  return lists;
}

SceneLists list_scenes(const std::string& node) {
  std::string data_dir;
  ros::param::get(node + "/data_dir", data_dir);  // stays empty if the node has none, or is not there
  SceneLists lists = list_folder(data_dir.empty() ? default_data_dir().toStdString() : data_dir);
  lists.installed = installed("scenarios");
  name_apart(lists);
  return lists;
}

QStringList list_species() { return installed("species"); }

}  // namespace desert_sim
