"""The operator that simulates a cloth: sample the scene, compute in a thread, play the result."""

import contextlib
import threading
import time

import bpy

from . import Refusal
from .bodies import said_of
from .modifiers import unchecked_movers
from .playing import play
from .operators import Reporting, object_mode
from .run import Run, RunOptions
from .sampling import sample

#: How long the interface may wait for samples at a time.
SAMPLING_SECONDS = 0.05


class SimulateCloth(Reporting, bpy.types.Operator):
    """Simulate the cloth from the scene's first frame to its last. Esc cancels; undo restores the previous motion"""

    bl_idname = "echinus.simulate_cloth"
    bl_label = "Simulate Cloth"
    bl_options = {"REGISTER", "UNDO"}

    is_running = False

    @classmethod
    def poll(cls, context):
        cls.poll_message_set("A simulation is running; Esc cancels it")
        return not SimulateCloth.is_running

    def execute(self, context):
        """Does all the work at once, for scripts."""
        began = time.monotonic()
        with object_mode(context):
            done, refused = self.refused_by(compute_at_once, context)
        if refused:
            return {"CANCELLED"}
        return self.finish(*done, time.monotonic() - began)

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        self.mode = contextlib.ExitStack()
        self.mode.enter_context(object_mode(context))
        self.began = time.monotonic()
        self.sampling, self.computing = sample(context), None
        self.timer = context.window_manager.event_timer_add(0.05, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        SimulateCloth.is_running = True
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Simulation cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            # The scene must not change while its frames are sampled.
            return {"PASS_THROUGH"} if self.computing else {"RUNNING_MODAL"}
        try:
            done, refused = self.refused_by(self.advance, context)
        except Exception:  # Blender shows it, and forgets the operator
            self.cancel(context)
            raise
        if refused:
            self.cancel(context)
            return {"CANCELLED"}
        if done is None:
            return {"RUNNING_MODAL"}
        self.end(context)
        return self.finish(*done, time.monotonic() - self.began)

    def cancel(self, context):
        """Blender also calls this when it closes or loads a file."""
        self.sampling.close()
        self.mode.close()
        if self.computing:
            self.computing.cancel()
        self.end(context)

    def end(self, context):
        SimulateCloth.is_running = False
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        if context.workspace:
            context.workspace.status_text_set(None)

    def advance(self, echinus, context):
        """Works for a moment; returns the sampled scene and the run after they are finished, otherwise None."""
        if self.computing is None:
            until = time.monotonic() + SAMPLING_SECONDS
            share = 0
            for share, self.sampled in self.sampling:
                if self.sampled:
                    self.mode.close()
                    make = run_maker(echinus, context, self.sampled)
                    self.computing = Computation(make)
                    break
                if time.monotonic() > until:
                    break
            self.show(context, f"Echinus reads frame {context.scene.frame_current}", share / 10)
            return None
        run = self.computing.result()
        if run:
            return self.sampled, run
        share = self.computing.share_done
        self.show(context, f"Echinus simulates {self.sampled.garment.name}: {share:.0%}", 0.1 + 0.9 * share)
        return None

    def show(self, context, sentence, share):
        context.window_manager.progress_update(round(100 * share))
        context.workspace.status_text_set(f"{sentence}; Esc cancels")

    def finish(self, sampled, run, seconds):
        _, refused = self.refused_by(self.keep, sampled, run, seconds)
        return {"CANCELLED"} if refused else {"FINISHED"}

    def keep(self, echinus, sampled, run, seconds):
        name, scene_name = sampled.garment.name, sampled.destination.scene_name
        scene = bpy.data.scenes.get(scene_name)
        cloth = scene and scene.objects.get(name)
        if cloth is None:
            raise Refusal(f"{name} is no longer in the scene {scene_name}: simulate again")
        if cloth.type != "MESH" or len(cloth.data.vertices) != len(sampled.garment.vertices):
            raise Refusal(f"{name} has other vertices than when the simulation began: simulate again")
        play(cloth, sampled.destination, run.recorded, sampled.matrices)
        profile = run.simulation.profile
        sentence = f"{name}: {len(run.recorded)} frames in {seconds:.1f} s"
        if profile.lost_count or profile.unresolved_count:
            sentence += f"; no room {profile.unresolved_count} times, {profile.lost_count} vertices lost"
        if not bpy.data.filepath and not sampled.destination.cache:
            sentence += "; save the blend file to keep the motion"
        reservations = said_of(sampled.skipped) + unchecked_movers(cloth)
        is_bad = bool(profile.lost_count or profile.unresolved_count or reservations)
        self.tell(scene, sentence + reservations, is_bad)


class Computation:
    """A run that is made and computed in a thread, which does not access Blender."""

    def __init__(self, make_run):
        self._cancelled = threading.Event()
        self._run, self._error, self._is_done = None, None, False
        self._thread = threading.Thread(target=self._compute, args=(make_run,), name="Echinus", daemon=True)
        self._thread.start()

    def _compute(self, make_run):
        try:
            self._run = make_run()
            while not self._run.is_done and not self._cancelled.is_set():
                self._run.step()
        except Exception as error:  # the thread that asks for the result raises it
            self._error = error
        self._is_done = True

    @property
    def share_done(self):
        return self._run.share_done if self._run else 0

    def result(self):
        """The run after it has finished, and None before.

        Raises
        ------
        Exception
            The exception that ended the computation.
        """
        if not self._is_done:
            return None
        self._thread.join()
        if self._error:
            raise self._error
        return self._run

    def cancel(self):
        self._cancelled.set()
        self._thread.join()


def compute_at_once(echinus, context):
    for _, sampled in sample(context):
        pass
    run = run_maker(echinus, context, sampled)()
    while not run.is_done:
        run.step()
    return sampled, run


def run_maker(echinus, context, sampled):
    """A function that makes the run from values only, so that a thread may call it."""
    scene = context.scene
    options = options_of(scene)
    frame_count = scene.frame_end - scene.frame_start
    frames_per_second = scene.render.fps / scene.render.fps_base
    return lambda: Run(echinus, sampled.garment, sampled.bodies, options, frame_count, frames_per_second)


def options_of(scene):
    """The options of a run. Gravity is in units of the scene, as for Blender's own cloth."""
    settings = scene.echinus
    return RunOptions(
        steps_per_second=settings.steps_per_second,
        gravity=tuple(scene.gravity) if scene.use_gravity else (0, 0, 0),
        thickness=settings.thickness,
        friction=settings.friction,
        air_drag=settings.air_drag,
        bending_stiffness=settings.bending_stiffness,
        self_collision=settings.self_collision,
        untangle=settings.untangle,
        pins_follow_body=settings.pins_follow_body,
    )
