// The bar below the picture: play, the time on a slider, and how fast it goes by.
import { element, icon, ICONS } from "./elements";
import type { Crash } from "./model";
import { SPEEDS, type Playback } from "./playback";
import { button } from "./toolbar";
import { time as inWords } from "./format";

export interface ControlEvents {
  toggle: () => void;
  /** Somebody moved the slider. */
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

  /** Another path: another end, and other collisions on the way. */
  setPath(playback: Playback, crashes: readonly Crash[], isWhole: boolean): void {
    const { duration } = playback;
    this.slider.max = `${duration}`;
    this.end = `${inWords(duration)}${isWhole ? "" : " …"}`;
    const isStill = duration === 0;
    for (const control of [this.slider, this.play, this.speeds]) control.disabled = isStill;
    this.marks.replaceChildren(
      ...crashes.flatMap(({ t }) => {
        if (t === null || isStill) return [];
        const mark = element("i");
        mark.style.setProperty("--share", `${t / duration}`);
        return [mark];
      }),
    );
    this.speeds.value = `${playback.speed}`;
    this.show(playback);
  }

  /** As time goes by. */
  show({ time, isPlaying, speed, duration }: Playback): void {
    this.slider.value = `${time}`;
    this.slider.style.setProperty("--share", `${duration > 0 ? time / duration : 0}`);
    this.slider.setAttribute("aria-valuetext", `${inWords(time)} of ${this.end}`);
    this.clock.value = `${inWords(time)} / ${this.end}`;
    if (isPlaying === this.isPlaying) return;
    this.isPlaying = isPlaying;
    const label = isPlaying ? "Pause (space)" : "Play (space)";
    this.play.title = label;
    this.play.setAttribute("aria-label", label);
    this.play.replaceChildren(icon(isPlaying ? ICONS.pause : ICONS.play));
    this.speeds.value = `${speed}`;
  }
}
