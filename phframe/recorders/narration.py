"""What was decided and why, and what came of it, in words."""

from __future__ import annotations

import math
from collections.abc import Iterable

from phframe.core import Condition, Episode, Motion, Plan, RunSpec, Scene, Status, Step
from phframe.pushing import Corridor, PushDecision


def opening_line(scene: Scene, spec: RunSpec) -> str:
    """What is about to be done, and with what."""
    others = _plural(len(scene.objects) - 1, "other object")
    planner, backend, arm, topology = map(spec.name_of, ("planner", "backend", "arm", "topology"))
    means = f"{planner}, {backend}, arm {arm}, {topology}, seed {spec.seed}"
    return f"{scene.name}: retrieve {scene.target} among {others} ({means})"


def plan_line(plan: Plan, number: int) -> str:
    """What a plan holds and what it cost."""
    title = "plan" if number == 1 else f"plan {number} (replanned)"
    cost = f"{1000 * plan.cost.total:.0f} ms, {plan.cost.simulated_actions} simulated actions"
    reason = f": {plan.reason}" if plan.reason else ""
    return f"{title}: {_plural(len(plan.actions), 'action')}, expected to end {plan.status}{reason} ({cost})"


def decision_line(step: Step, number: int) -> str:
    """An action and why it was chosen."""
    decision = PushDecision.of(step.decision)
    parts = [*_crowd(decision), *_grouping(decision)] or [decision.why]
    return f"{number}. {step.action.name}" + (f" ({'; '.join(parts)})" if any(parts) else "")


def outcome_line(step: Step, scene: Scene, number: int) -> str:
    """What an action did."""
    return f"{number}. done in {', '.join(_outcome(step, scene))}"


def tried_line(step: Step, scene: Scene, number: int, closed: str) -> str:
    """What an action of a plan that failed did when it was simulated, and why the search did not go on from there."""
    why = f"; given up: {closed}" if closed else ""
    return f"{number}. only simulated: {', '.join(_outcome(step, scene))}{why}"


def ending_line(episode: Episode) -> str:
    """How it ended."""
    reason = f": {episode.reason}" if episode.reason else ""
    return (
        f"{episode.status}{reason}; {_plural(episode.pushes, 'push', 'pushes')}, {_plural(episode.replans, 'replan')}, "
        f"{1000 * episode.cost.total:.0f} ms planning, {episode.execution_time:.1f} s execution"
    )


def decision_page(step: Step, scene: Scene, number: int, done: bool) -> str:
    """The same at length, as Markdown, with the outcome once the action is ``done``."""
    decision = PushDecision.of(step.decision)
    rows = [
        ("why", decision.why),
        ("corridor", _corridor(decision.corridor)),
        ("obstacles", ", ".join(decision.members)),
        ("persistent radii", _millimetres(decision.persistent_radii)),
        ("chosen radius", _radius(decision)),
        ("chosen component", ", ".join(decision.chosen)),
        ("deviations", ", ".join(decision.deviations)),
        ("outcome", ", ".join(_outcome(step, scene)) if done else ""),
    ]
    told = "\n".join(f"- **{name}**: {value}" for name, value in rows if value)
    return f"#### {number}. {step.action.name}\n\n{told}\n"


def ending_page(episode: Episode) -> str:
    """How it ended, as Markdown."""
    lines = "\n".join(f"{i}. {step.action.name}" for i, step in enumerate(episode.steps, 1))
    return f"#### {episode.status}\n\n{ending_line(episode)}\n\n{lines}\n"


def is_good(status: Status) -> bool:
    """Whether the target could be grasped."""
    return status in (Status.RETRIEVED, Status.REACHED)


def went_wrong(step: Step, scene: Scene) -> bool:
    """Whether an action touched a wall, stalled, was stopped or let something fall."""
    motion = step.motion
    return bool(motion.wall_contacts or not motion.complete or _fallen(step, scene))


def _crowd(decision: PushDecision) -> Iterable[str]:
    if decision.corridor is not None:
        yield _plural(len(decision.members), "obstacle") if decision.members else "no obstacle"


def _grouping(decision: PushDecision) -> Iterable[str]:
    if decision.persistent_radii:
        yield f"radii {_millimetres(decision.persistent_radii)}"
    if decision.radius is not None:
        yield f"chosen {_radius(decision)}"


def _corridor(corridor: Corridor | None) -> str:
    if corridor is None:
        return ""
    shape = "straight" if corridor.beside is None else f"along the {corridor.beside} wall, {_degrees(corridor.angle)}"
    return f"{shape}, {2000 * corridor.half_width:.0f} mm wide"


def _radius(decision: PushDecision) -> str:
    if decision.radius is None:
        return ""
    groups = len(set(components)) if (components := _labels(decision)) else 0
    return f"{1000 * decision.radius:.0f} mm" + (f", {_plural(groups, 'component')}" if groups else "")


def _labels(decision: PushDecision) -> list[int]:
    return [] if decision.labels is None else [int(label) for label in decision.labels]


def _outcome(step: Step, scene: Scene) -> list[str]:
    return [
        f"{step.motion.duration:.1f} s",
        f"largest force {step.motion.largest_force:.0f} N",
        *_troubles(step.motion),
    ] + [f"{object_id} {condition}" for object_id, condition in _fallen(step, scene)]


def _troubles(motion: Motion) -> Iterable[str]:
    if motion.stalled:
        yield "stalled at the force limit"
    if motion.stopped is not None:
        yield f"stopped: {motion.stopped}"
    yield from (f"touched the {body}" for body in dict.fromkeys(contact.body for contact in motion.wall_contacts))


def _fallen(step: Step, scene: Scene) -> list[tuple[str, Condition]]:
    """What fell during a step; the object in the hand did not."""
    changes = zip(scene.ids, step.before.conditions, step.after.conditions, strict=True)
    return [(i, after) for i, before, after in changes if after is not before and i != step.after.held]


def _millimetres(radii: Iterable[float]) -> str:
    values = ", ".join(f"{1000 * radius:.0f}" for radius in radii)
    return f"{values} mm" if values else ""


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.0f}°"


def _plural(count: int, one: str, many: str | None = None) -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"
