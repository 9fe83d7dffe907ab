import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const NEAR = 0.05; // m
const FAR = 500;
const PANELS = 736; // pixels: where the page is wider its panel stands on the left, see style.css
const SIDE = 280;
const FOOT = 80;

/** The canvas: a camera that turns about the world, z up, drawn only when something has changed. */
export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(50, 1, NEAR, FAR);
  frames = 0;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly ray = new THREE.Raycaster();
  private due = false;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.listenToKeyEvents(canvas);
    this.controls.maxPolarAngle = 0.495 * Math.PI; // not from beneath
    this.controls.addEventListener('change', () => this.draw());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 2.2));
    const sun = new THREE.DirectionalLight(0xffffff, 1.6);
    sun.position.set(-3, -5, 8);
    this.scene.add(sun);
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener('keydown', (event) => this.key(event));
    this.resize();
  }

  /** Looks at all of a box from the south-west. */
  frame(box: THREE.Box3): void {
    const centre = box.getCenter(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3());
    const far = (0.75 * Math.hypot(size.x, size.y)) / Math.min(1, this.camera.aspect);
    this.controls.target.set(centre.x, centre.y, 0);
    this.camera.position.set(centre.x - 0.25 * far, centre.y - 0.85 * far, 0.95 * far);
    this.camera.far = Math.max(FAR, 6 * far);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  /** Turns to a point without going nearer. */
  lookAt(point: THREE.Vector3): void {
    this.camera.position.add(point.clone().sub(this.controls.target));
    this.controls.target.copy(point);
    this.controls.update();
    this.draw();
  }

  /** The nearest of `among` under a point of the page, if one is there. */
  pick(x: number, y: number, among: THREE.Object3D[]): THREE.Object3D | undefined {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2(
      (2 * (x - box.left)) / box.width - 1,
      1 - (2 * (y - box.top)) / box.height,
    );
    this.ray.setFromCamera(at, this.camera);
    return this.ray.intersectObjects(among, false)[0]?.object;
  }

  /** With the next picture of the screen, however often it is asked for before. */
  draw(): void {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.frames += 1;
      this.renderer.render(this.scene, this.camera);
    });
  }

  private key(event: KeyboardEvent): void {
    const factor = event.key === '+' ? 0.85 : event.key === '-' ? 1 / 0.85 : 0;
    if (factor) {
      const away = this.camera.position.clone().sub(this.controls.target);
      this.camera.position.copy(this.controls.target).add(away.multiplyScalar(factor));
      this.controls.update();
    }
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    // What is looked at stands in the middle of what the panels leave.
    const wide = clientWidth > PANELS;
    this.camera.setViewOffset(
      clientWidth, clientHeight, wide ? -SIDE / 2 : 0, wide ? FOOT / 2 : clientHeight / 5,
      clientWidth, clientHeight,
    );
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
