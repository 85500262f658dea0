// The pointer on the picture: drag to move the floor, turn the wheel to zoom, point at an action, click to go to it.

export interface PointerEvents {
  pan: (dx: number, dy: number) => void;
  zoom: (factor: number, px: number, py: number) => void;
  point: (px: number, py: number) => void;
  leave: () => void;
  click: (px: number, py: number) => void;
  fit: () => void;
}

/** What moves less is a click, pixels. */
const STILL = 4;

export function watchPointer(surface: HTMLElement, events: PointerEvents): void {
  const held = new Map<number, { x: number; y: number }>();
  let moved = 0;
  const place = (event: MouseEvent): [number, number] => {
    const { left, top } = surface.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  surface.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const [x, y] = place(event);
    if (held.size === 0) moved = 0;
    held.set(event.pointerId, { x, y });
    surface.setPointerCapture(event.pointerId);
  });
  surface.addEventListener("pointermove", (event) => {
    const [x, y] = place(event);
    const before = held.get(event.pointerId);
    if (!before) {
      events.point(x, y);
      return;
    }
    moved += Math.hypot(x - before.x, y - before.y);
    const other = [...held].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const [far, near] = [Math.hypot(x - other.x, y - other.y), Math.hypot(before.x - other.x, before.y - other.y)];
      if (near > 0) events.zoom(far / near, other.x, other.y);
    } else if (moved > STILL) {
      surface.classList.add("dragging");
      events.leave();
      events.pan(x - before.x, y - before.y);
    }
    held.set(event.pointerId, { x, y });
  });
  const release = (event: PointerEvent): void => {
    if (!held.delete(event.pointerId)) return;
    surface.classList.remove("dragging");
    if (event.type === "pointerup" && moved <= STILL) events.click(...place(event));
  };
  surface.addEventListener("pointerup", release);
  surface.addEventListener("pointercancel", release);
  surface.addEventListener("pointerleave", events.leave);
  surface.addEventListener("dblclick", events.fit);
  surface.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      // A trackpad's pinch comes as a wheel with Control, in small numbers.
      const strength = event.ctrlKey ? 0.01 : 0.0015;
      events.zoom(Math.exp(-event.deltaY * lines * strength), ...place(event));
    },
    { passive: false },
  );
}
