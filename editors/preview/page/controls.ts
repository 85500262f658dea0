// The bar below the picture: play, the time slider and the speed.
import { element, icon, ICONS } from "./elements";
import { duration as formatDuration } from "./format";
import type { Collision } from "./model";
import { SPEEDS, type Playback } from "./playback";
import { button } from "./toolbar";

export interface ControlEvents {
  toggle: () => void;
  seek: (time: number) => void;
  setSpeed: (speed: number) => void;
}

export class Controls {
  readonly bar: HTMLElement;
  readonly slider = element("input", { type: "range", min: "0", step: "any", value: "0", "aria-label": "Time", "data-part": "slider" });
  private readonly play: HTMLButtonElement;
  private readonly clock = element("output", { "data-part": "clock", "aria-hidden": "true" });
  private readonly speeds = element("select", { "aria-label": "Speed", title: "Speed", "data-part": "speed" });
  private readonly marks = element("div", { class: "marks", "aria-hidden": "true" });
  private isPlaying: boolean | undefined;
  private end = "";

  constructor(events: ControlEvents) {
    this.play = button("Play (space)", ICONS.play, "play", events.toggle);
    this.slider.addEventListener("input", () => events.seek(Number(this.slider.value)));
    for (const speed of SPEEDS) this.speeds.append(element("option", { value: `${speed}` }, `${speed}×`));
    this.speeds.addEventListener("change", () => events.setSpeed(Number(this.speeds.value)));
    const track = element("div", { class: "track" }, this.marks, this.slider);
    this.bar = element("footer", { class: "controls" }, this.play, track, this.clock, this.speeds);
  }

  /** Shows a path's duration and its collisions on the slider. */
  setPath(playback: Playback, collisions: readonly Collision[], isComplete: boolean): void {
    const { duration } = playback;
    this.slider.max = `${duration}`;
    this.end = `${formatDuration(duration)}${isComplete ? "" : " …"}`;
    const isEmpty = duration === 0;
    for (const control of [this.slider, this.play, this.speeds]) control.disabled = isEmpty;
    this.marks.replaceChildren(
      ...collisions.flatMap(({ t }) => {
        if (t === null || isEmpty) return [];
        const mark = element("i");
        mark.style.setProperty("--share", `${t / duration}`);
        return [mark];
      }),
    );
    this.speeds.value = `${playback.speed}`;
    this.show(playback);
  }

  /** Shows the state of the playback. */
  show({ time, isPlaying, speed, duration }: Playback): void {
    this.slider.value = `${time}`;
    this.slider.style.setProperty("--share", `${duration > 0 ? time / duration : 0}`);
    this.slider.setAttribute("aria-valuetext", `${formatDuration(time)} of ${this.end}`);
    this.clock.value = `${formatDuration(time)} / ${this.end}`;
    if (isPlaying === this.isPlaying) return;
    this.isPlaying = isPlaying;
    const label = isPlaying ? "Pause (space)" : "Play (space)";
    this.play.title = label;
    this.play.setAttribute("aria-label", label);
    this.play.replaceChildren(icon(isPlaying ? ICONS.pause : ICONS.play));
    this.speeds.value = `${speed}`;
  }
}
