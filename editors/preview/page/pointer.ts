// Pointer gestures on the picture: drag to pan, wheel or pinch to zoom, hover over an action, click to reveal it.

export interface PointerEvents {
  pan: (dx: number, dy: number) => void;
  zoom: (factor: number, px: number, py: number) => void;
  hover: (px: number, py: number) => void;
  leave: () => void;
  click: (px: number, py: number) => void;
  fit: () => void;
}

/** A shorter drag is a click, pixels. */
const CLICK_DISTANCE = 4;

export function watchPointer(surface: HTMLElement, events: PointerEvents): void {
  const pressed = new Map<number, { x: number; y: number }>();
  let moved = 0;
  const positionOf = (event: MouseEvent): [number, number] => {
    const { left, top } = surface.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  surface.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const [x, y] = positionOf(event);
    if (pressed.size === 0) moved = 0;
    pressed.set(event.pointerId, { x, y });
    surface.setPointerCapture(event.pointerId);
  });
  surface.addEventListener("pointermove", (event) => {
    const [x, y] = positionOf(event);
    const before = pressed.get(event.pointerId);
    if (!before) {
      events.hover(x, y);
      return;
    }
    moved += Math.hypot(x - before.x, y - before.y);
    const other = [...pressed].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const [far, near] = [Math.hypot(x - other.x, y - other.y), Math.hypot(before.x - other.x, before.y - other.y)];
      if (near > 0) events.zoom(far / near, other.x, other.y);
    } else if (moved > CLICK_DISTANCE) {
      surface.classList.add("dragging");
      events.leave();
      events.pan(x - before.x, y - before.y);
    }
    pressed.set(event.pointerId, { x, y });
  });
  const release = (event: PointerEvent): void => {
    if (!pressed.delete(event.pointerId)) return;
    surface.classList.remove("dragging");
    if (event.type === "pointerup" && moved <= CLICK_DISTANCE) events.click(...positionOf(event));
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
      // Browsers report a pinch on a trackpad as small wheel steps with Control.
      const strength = event.ctrlKey ? 0.01 : 0.0015;
      events.zoom(Math.exp(-event.deltaY * lines * strength), ...positionOf(event));
    },
    { passive: false },
  );
}
