#pragma once
/// Connections to this node that wait to be taken.

namespace desert_sim {

/// Lets as many connections to the XML-RPC server wait as the kernel allows (SOMAXCONN). roscpp listens
/// with a backlog of 5 (XmlRpcServer::bindAndListen): where more clients come while the node is busy, the
/// kernel resets the connections of some, and roscpp's clients do not ask again. To be called after
/// ros::start(). Warns where that fails (no /proc, say): the node serves as other nodes of roscpp do.
void widen_xmlrpc_backlog();

}  // namespace desert_sim
