"""A planner in one file. Try it: phframe solve --planner docs/examples/best_next_push.py:BestNextPush."""

from collections.abc import Iterator

from phframe.core import ROOT, Plan, Planner, Task
from phframe.pushing import Proposal, PushingOptions, PushProblem, PushSearch


class BestNextPush(Planner[PushingOptions]):
    """Simulates a push at every usable radius, and keeps the one that leaves the fewest obstacles in the corridor."""

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Look one push ahead, again and again, until the target can be grasped."""
        search, node = PushSearch(task, self.options), ROOT
        while isinstance(step := search.next_step(node), PushProblem):
            children = search.try_pushes(node, self.pushes(search, step))
            left = {child: step.corridor.contains(search.state(child).positions).sum() for child in children}
            best = min(left, key=lambda child: left[child], default=node)
            if best == node or left[best] >= len(step.members) or search.tree.depth(best) > self.options.max_actions:
                return search.fail(node, "no push leaves fewer obstacles in the corridor")
            search.take(best)
            node = best
        return search.finish(node, step)

    def pushes(self, search: PushSearch, problem: PushProblem) -> Iterator[Proposal]:
        """The pushes of the closest component at every usable radius, and at the least distance that lets the gripper in."""
        diagram = search.pushing.diagram(problem)
        for radius in [*search.pushing.radii(diagram), search.pushing.threshold]:
            yield from search.pushing.pushes(problem, diagram, radius)
