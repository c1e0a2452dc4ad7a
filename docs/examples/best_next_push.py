"""A planner in one file. Try it: phframe solve --planner docs/examples/best_next_push.py:BestNextPush."""

from dataclasses import replace

from phframe.core import Infeasible, Plan, Planner, Status, Task
from phframe.pushing.options import PushingOptions
from phframe.pushing.persistence import usable_radii
from phframe.pushing.push_problem import Pushing


class BestNextPush(Planner[PushingOptions]):
    """Simulates a push at every usable radius, and keeps the one that leaves the fewest obstacles in the corridor."""

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Look one push ahead, again and again, until the corridor is empty."""
        pushing, state = Pushing(task, self.options), task.start
        plan = Plan(Status.CLEARED, "the corridor is empty; the episode finds the grasp")
        for _ in range(self.options.max_actions):
            problem = pushing.problem(state)
            if isinstance(problem, Infeasible):
                return replace(plan, status=Status.FAILED, reason=problem.reason)
            if len(problem.members) == 0:
                return plan
            diagram = pushing.diagram(problem)
            radii = [*usable_radii(diagram.finite_deaths, self.options.margin, pushing.threshold), pushing.threshold]
            pushes = [push for radius in radii for push in pushing.pushes(problem, diagram, float(radius))]
            outcomes = [transition.state for transition in task.apply_many([(state, action) for _, action in pushes])]
            left = [int(problem.corridor.contains(outcome.positions).sum()) for outcome in outcomes]
            if min(left, default=len(problem.members)) >= len(problem.members):
                return replace(plan, status=Status.FAILED, reason="no push leaves fewer obstacles in the corridor")
            (decision, action), state = pushes[left.index(min(left))], outcomes[left.index(min(left))]
            plan = replace(
                plan,
                actions=(*plan.actions, action),
                expected=(*plan.expected, state),
                decisions=(*plan.decisions, decision),
            )
        return replace(plan, status=Status.FAILED, reason="the corridor is not empty after all the pushes allowed")
