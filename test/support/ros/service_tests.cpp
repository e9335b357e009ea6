#include "test/support/ros/service_tests.hpp"
