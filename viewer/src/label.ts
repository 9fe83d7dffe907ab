import { CanvasTexture, LinearFilter, Sprite, SpriteMaterial } from 'three';

const HEIGHT = 44; // pixels of the texture
const SCALE = 0.00055; // of the picture's height per pixel

/** A line of text that faces the camera and is as large near as far. */
export class Label extends Sprite {
  private text = '';

  constructor() {
    super(new SpriteMaterial({ depthTest: false, sizeAttenuation: false, transparent: true }));
    this.center.set(0.5, -0.3);
    this.renderOrder = 10;
  }

  set(text: string): void {
    if (text === this.text) return;
    this.text = text;
    const canvas = document.createElement('canvas');
    const pen = canvas.getContext('2d')!;
    const font = '600 28px system-ui, sans-serif';
    pen.font = font;
    canvas.width = Math.ceil(pen.measureText(text).width) + 20;
    canvas.height = HEIGHT;
    pen.font = font;
    pen.fillStyle = 'rgba(20, 22, 26, 0.72)';
    pen.beginPath();
    pen.roundRect(0, 0, canvas.width, HEIGHT, 10);
    pen.fill();
    pen.fillStyle = '#ffffff';
    pen.textBaseline = 'middle';
    pen.fillText(text, 10, HEIGHT / 2 + 1);
    this.material.map?.dispose();
    this.material.map = new CanvasTexture(canvas);
    this.material.map.minFilter = LinearFilter;
    this.material.needsUpdate = true;
    this.scale.set(SCALE * canvas.width, SCALE * HEIGHT, 1);
  }

  dispose(): void {
    this.material.map?.dispose();
    this.material.dispose();
  }
}
