"""Calls of services that raise what the node says is wrong."""
import ast
import re

import rospy


class SimulationError(RuntimeError):
    """A node has refused a request, which then changed nothing, or does not answer.

    service   full name of the service, topic or action
    reason    the node's own words: what is wrong with which value, and what is allowed
    """

    def __init__(self, service, reason):
        name = service.rsplit("/", 1)[-1] + ": "  # some reasons begin with the name of the command
        super().__init__("%s: %s" % (service, reason[len(name):] if reason.startswith(name) else reason))
        self.service, self.reason = service, reason


def _words_of(error):
    """What the node says of a call that failed; rospy gives it within a sentence, as bytes are written in Python."""
    said = re.fullmatch(r"service \[[^]]*\] responded with an error: (b(['\"]).*\2)", str(error), re.DOTALL)
    return ast.literal_eval(said[1]).decode("utf-8", "replace") if said else str(error)


def call(service, kind, timeout, *arguments, **fields):
    """The answer of a service.

    service   full name, such as /desert_sim/step
    kind      its type, such as desert_sim.srv.Step
    timeout   seconds of wall time to wait until the service is there; its answer is waited for as long as it takes
    The rest is the request: one message, or its fields.
    Raises SimulationError with the reason if the service is not there, the connection breaks, or `success` is false.
    """
    try:
        rospy.wait_for_service(service, timeout)
        answer = rospy.ServiceProxy(service, kind)(*arguments, **fields)
    except rospy.ServiceException as error:
        raise SimulationError(service, _words_of(error)) from error
    except rospy.ROSInterruptException:
        raise
    except rospy.ROSException as error:
        raise SimulationError(service, "there is no such service after %g s: does the node run?" % timeout) from error
    if not getattr(answer, "success", True):
        raise SimulationError(service, answer.message)
    return answer
