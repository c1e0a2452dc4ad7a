"""The conformance kit: what authors of planners, backends, arms, topology engines and goals run on their own code.

Each ``check_...`` runs many small checks, to the last one, and raises one ``ConformanceError`` that lists what was
expected, what was found and what the contract says. To have a test for each check, parametrise with the tuples::

    @pytest.mark.parametrize("check", ARM_CHECKS, ids=lambda check: check.name)
    def test_my_arm(check):
        check(ArmUnderTest(MyArm(MyOptions())))
"""

from phframe.testing.arm import ARM_CHECKS, check_arm
from phframe.testing.check import Check, ConformanceError, Failure, Fault, NotApplicableError, Report
from phframe.testing.goal import GOAL_CHECKS, check_goal
from phframe.testing.physics import PHYSICS_CHECKS, check_physics
from phframe.testing.planner import PLANNER_CHECKS, check_planner, order_of_objects_does_not_matter, simulated_tasks
from phframe.testing.subjects import ArmUnderTest, EngineUnderTest, GoalUnderTest, PhysicsUnderTest, PlannerUnderTest
from phframe.testing.tolerances import JOINTED, PLANAR, SPATIAL, PhysicsTolerances
from phframe.testing.topology import TOPOLOGY_CHECKS, check_topology

__all__ = [
    "ARM_CHECKS",
    "GOAL_CHECKS",
    "JOINTED",
    "PHYSICS_CHECKS",
    "PLANAR",
    "PLANNER_CHECKS",
    "SPATIAL",
    "TOPOLOGY_CHECKS",
    "ArmUnderTest",
    "Check",
    "ConformanceError",
    "EngineUnderTest",
    "Failure",
    "Fault",
    "GoalUnderTest",
    "NotApplicableError",
    "PhysicsTolerances",
    "PhysicsUnderTest",
    "PlannerUnderTest",
    "Report",
    "check_arm",
    "check_goal",
    "check_physics",
    "check_planner",
    "check_topology",
    "order_of_objects_does_not_matter",
    "simulated_tasks",
]
